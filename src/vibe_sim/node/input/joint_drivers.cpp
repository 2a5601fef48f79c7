#include "input/joint_drivers.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "vibe_core/input/joint_unit.hpp"

namespace vibe::sim {
namespace {

constexpr double kStill = 1e-3, kStillTurn = M_PI / 180;  // less is no motion [m], [rad]
constexpr double kThere = 5;  // times that: a follower of the joints lags behind them, and asks for nothing else

bool areNear(const JointArray& a, const JointArray& b, const InputSample& sample, double times) {
  const bool scope = sample.channel == InputChannel::Scope;
  for (int j = scope ? 0 : kScopeJointCount; j < (scope ? kScopeJointCount : kJointCount); ++j) {
    const auto i = static_cast<std::size_t>(j);
    if (std::abs(a[i] - b[i]) > times * (isPrismatic(j) ? kStill : kStillTurn)) return false;
  }
  return true;
}

bool repeats(const InputSample& sample, const InputSample& anchor) {
  if (sample.target != anchor.target || sample.move != anchor.move) return false;
  switch (sample.target) {
    case ScopeTarget::Joints:
      return areNear(sample.joints, anchor.joints, sample, 1);
    case ScopeTarget::TipInWorld:
    case ScopeTarget::TipInBase:
      return (sample.tip_pose.translation() - anchor.tip_pose.translation()).norm() <= kStill &&
             Eigen::AngleAxisd(sample.tip_pose.linear().transpose() * anchor.tip_pose.linear()).angle() <= kStillTurn;
    case ScopeTarget::VelocityInWorld:
    case ScopeTarget::VelocityInBase:
      return sample.tip_twist.isZero();
  }
  return false;
}

/// A word for the frame of a pose or of a velocity; others have none to change.
const char* frameOf(ScopeTarget target, ScopeTarget in_world, ScopeTarget in_base) {
  return target == in_world ? "world" : target == in_base ? "scope_base" : "";
}

std::string frameChange(const InputSample& sample, const InputSample& anchor) {
  for (const auto& [world, base] : {std::pair(ScopeTarget::TipInWorld, ScopeTarget::TipInBase),
                                    std::pair(ScopeTarget::VelocityInWorld, ScopeTarget::VelocityInBase)}) {
    const std::string before = frameOf(anchor.target, world, base), now = frameOf(sample.target, world, base);
    if (before != now && !before.empty() && !now.empty())
      return topicOf(sample) + " has changed its frame from '" + before + "' to '" + now +
             "' between two messages and is used as it says; send all in one frame if that was not meant.";
  }
  return "";
}

bool isThere(const InputSample& sample, const JointArray& hand) {
  return sample.target == ScopeTarget::Joints && areNear(sample.joints, hand, sample, kThere);
}

}  // namespace

bool JointDrivers::obeys(const InputSample& sample, const JointArray& hand, std::string& sentence) {
  const std::int64_t now = sample.stamp;
  heard_.erase(std::remove_if(heard_.begin(), heard_.end(), [now](const Driver& d) { return now - d.heard > kRest; }),
               heard_.end());
  const auto is_sender = [&sample](const Driver& d) { return isOfOneNode(d.sender, sample.sender); };
  auto own = std::find_if(heard_.begin(), heard_.end(), is_sender);
  const bool first = own == heard_.end();
  if (first) own = heard_.insert(own, {sample.sender, sample, now, std::nullopt});
  own->heard = now;
  sentence = frameChange(sample, own->anchor);
  const bool drives = isOfOneNode(driver_, sample.sender);
  const Driver* const other = drives ? nullptr : movingDriver(now);
  const bool changes = !first && !repeats(sample, own->anchor);
  const bool moves = changes && !(other != nullptr && isThere(sample, hand));
  const bool begins = moves && (!own->moved || now - *own->moved > kRest);
  if (changes) own->anchor = sample;
  if (moves) own->moved = now;
  if (drives || first || begins || (moves && other == nullptr)) {
    driver_ = sample.sender;
    return true;
  }
  if (moves && other->sender != nullptr && sample.sender != nullptr)
    sentence = sample.sender->topic + " of " + sample.sender->node + " is ignored while " + other->sender->topic +
               " of " + other->sender->node +
               " moves the same joints, because that began later; stop one of them, or let it rest for 0.3 s.";
  return false;
}

const JointDrivers::Driver* JointDrivers::movingDriver(std::int64_t stamp) const {
  for (const Driver& each : heard_)
    if (isOfOneNode(each.sender, driver_) && each.moved && stamp - *each.moved <= kRest) return &each;
  return nullptr;
}

}  // namespace vibe::sim
