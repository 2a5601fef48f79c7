#include "input/input_queue.hpp"

#include <algorithm>
#include <cmath>

#include "vibe_core/constraints/pull_patch.hpp"
#include "vibe_core/state/pull_spring.hpp"

namespace vibe::sim {

namespace {

constexpr double kReached = 5e-3;  // of the tip from its target: close enough to say nothing [m]

std::string beyondReach(const Eigen::Vector3d& target, const Model& model, const StepInput& input) {
  std::vector<Eigen::Isometry3d> poses;
  model.tool->forwardKinematics(input.joints, poses);
  const double miss = (poses[model.tip_link].translation() - target).norm();
  if (miss < kReached) return "";
  return "scope/servo_cp asks for a place that the scope misses by " + std::to_string(std::lround(1e3 * miss)) +
         " mm; it goes as near as it can.";
}

std::string reachTip(const InputSample& sample, const Model& model, StepInput& input) {
  if (!model.tool)
    return "scope/servo_cp has no effect because the scene '" + model.scene.name +
           "' has no scope; load a scene with one.";
  const bool in_world = sample.target == ScopeTarget::TipInWorld;
  const Eigen::Isometry3d pose = in_world ? model.tool_base.inverse() * sample.tip_pose : sample.tip_pose;
  input.joints = model.tool->inverseKinematics(pose, input.joints);
  return beyondReach(pose.translation(), model, input);
}

// A pull that the model rejects ends the pull in force: the user has asked for another one.
std::string applyPull(const InputSample& sample, const Model& model, StepInput& input) {
  const bool asks = sample.pull_particle >= 0 && sample.pull_particle != input.pull_particle;
  const std::string reason = asks ? pullRejection(model, sample.pull_particle) : "";
  input.pull_particle = reason.empty() ? sample.pull_particle : -1;
  input.pull_target = input.pull_particle < 0 ? Eigen::Vector3d::Zero() : sample.pull_target;
  return reason.empty() ? "" : "tissue/pull has no effect because " + reason;
}

/// @return one sentence if the model cannot use the sample, otherwise empty
std::string applyValues(const InputSample& sample, const Model& model, StepInput& input) {
  if (sample.target != ScopeTarget::Joints) return reachTip(sample, model, input);
  switch (sample.channel) {
    case InputChannel::Scope:
      std::copy_n(sample.joints.begin(), kScopeJointCount, input.joints.begin());
      break;
    case InputChannel::Overstitch:
      std::copy(sample.joints.begin() + kScopeJointCount, sample.joints.end(), input.joints.begin() + kScopeJointCount);
      break;
    case InputChannel::Buttons:
      input.buttons = sample.buttons;
      break;
    case InputChannel::Pull:
      return applyPull(sample, model, input);
  }
  return "";
}

/// @return names of what was pressed; empty: nothing
std::string releaseButtons(StepInput& input) {
  std::string names;
  for (int b = 0; b < kButtonCount; ++b) {
    if (!input.buttons[b]) continue;
    names += (names.empty() ? "" : ", ") + std::string(kButtonNames[b]);
    input.buttons[b] = 0;
  }
  return names;
}

}  // namespace

InputQueue::InputQueue() = default;

bool InputQueue::push(const InputSample& sample) {
  const auto channel = static_cast<std::size_t>(sample.channel);
  const std::int64_t stamp = std::max(sample.stamp, applied_until_.load());
  const bool replaces = taken_[channel] > 0 && stamp == last_pushed_[channel];
  if (!replaces && taken_[channel] >= kCapacity) return false;
  ++taken_[channel];
  if (!inbox_.push(sample)) {
    --taken_[channel];
    return false;
  }
  last_pushed_[channel] = stamp;
  return true;
}

void InputQueue::collect() {
  inbox_.consume_all([this](const InputSample& sample) { insert(sample); });
}

void InputQueue::insert(const InputSample& sample) {
  const auto channel = static_cast<std::size_t>(sample.channel);
  Queue& queue = queues_[channel];
  InputSample item = sample;
  item.stamp = std::max(sample.stamp, applied_until_.load());
  const auto later = std::upper_bound(queue.waiting.begin(), queue.waiting.end(), item.stamp,
                                      [](std::int64_t stamp, const InputSample& other) { return stamp < other.stamp; });
  const bool replaces = later != queue.waiting.begin() && std::prev(later)->stamp == item.stamp;
  if (replaces || queue.waiting.full()) {
    *(later == queue.waiting.begin() ? later : std::prev(later)) = item;
    --taken_[channel];
  } else {
    queue.waiting.insert(later, item);
  }
  queue.newest = std::max(queue.newest, sample.stamp);
}

bool InputQueue::knownUntil(std::int64_t stamp) {
  collect();
  return std::all_of(queues_.begin(), queues_.begin() + kLockstepChannelCount,
                     [stamp](const Queue& queue) { return queue.newest >= stamp; });
}

std::string InputQueue::missingAt(std::int64_t stamp) {
  collect();
  std::string names;
  for (int channel = 0; channel < kLockstepChannelCount; ++channel) {
    if (queues_[channel].newest >= stamp) continue;
    names += (names.empty() ? "" : ", ") + std::string(toString(static_cast<InputChannel>(channel)));
  }
  return names;
}

std::vector<std::string> InputQueue::apply(std::int64_t stamp, const Model& model, StepInput& input, bool real_time,
                                           const std::optional<JointArray>& hand) {
  collect();
  if (stamp < applied_until_) setBack(stamp);
  const JointArray start = hand.value_or(input.joints);
  std::vector<std::string> sentences;
  for (Queue& queue : queues_) {
    while (!queue.waiting.empty() && queue.waiting.front().stamp <= stamp) {
      const InputSample& sample = queue.waiting.front();
      std::string sentence = applySample(sample, stamp, model, start, input);
      if (!sentence.empty()) sentences.push_back(std::move(sentence));
      last_[static_cast<int>(sample.channel)] = stamp;
      --taken_[static_cast<std::size_t>(sample.channel)];
      queue.waiting.pop_front();
    }
  }
  applyMoves(stamp, input.joints);
  if (input.pull_particle >= 0 && isSilent(InputChannel::Pull, stamp, kPullTimeout)) {
    input.pull_particle = -1;
    input.pull_target.setZero();
    sentences.push_back(
        "The hand on tissue/pull has been silent for 2 s and lets go; send its target again while it "
        "holds.");
  }
  if (real_time && isSilent(InputChannel::Buttons, stamp, kButtonTimeout)) {
    const std::string released = releaseButtons(input);
    if (!released.empty())
      sentences.push_back(
          "No message has come on scope/buttons for 1 s, so the scope stays where it is and these buttons "
          "are released: " +
          released + "; send pressed buttons at 10 Hz.");
  }
  applied_until_ = stamp;
  return sentences;
}

std::string InputQueue::applySample(const InputSample& sample, std::int64_t stamp, const Model& model,
                                    const JointArray& hand, StepInput& input) {
  moves_[static_cast<int>(sample.channel)].reset();
  return sample.move ? beginMove(sample, stamp, model, hand) : applyValues(sample, model, input);
}

std::string InputQueue::beginMove(const InputSample& sample, std::int64_t stamp, const Model& model,
                                  const JointArray& hand) {
  const bool scope = sample.channel == InputChannel::Scope;
  if (!model.tool)
    return std::string(scope ? "scope" : "overstitch") + "/move_jp has no effect because the scene '" +
           model.scene.name + "' has no scope; load a scene with one.";
  const int first = scope ? 0 : kScopeJointCount, count = scope ? kScopeJointCount : kJointCount - kScopeJointCount;
  moves_[static_cast<int>(sample.channel)].emplace(hand, sample.joints, first, count, model.tool->limits(), stamp);
  return "";
}

void InputQueue::applyMoves(std::int64_t stamp, JointArray& joints) {
  for (std::optional<JointMove>& move : moves_) {
    if (!move) continue;
    move->apply(stamp, joints);
    if (stamp >= move->end()) move.reset();
  }
}

bool InputQueue::moves(InputChannel channel) const {
  return moves_[static_cast<int>(channel)].has_value();
}

void InputQueue::endMoves() {
  moves_ = {};
}

void InputQueue::setBack(std::int64_t stamp) {
  for (Queue& queue : queues_) {
    for (InputSample& sample : queue.waiting) sample.stamp = std::min(sample.stamp, stamp);
    queue.newest = std::min(queue.newest, stamp);
  }
  for (std::int64_t& last : last_) last = std::min(last, stamp);
  moves_ = {};
  applied_until_ = stamp;
}

// One that has promised a later sample is not.
bool InputQueue::isSilent(InputChannel channel, std::int64_t stamp, std::int64_t timeout) const {
  const int c = static_cast<int>(channel);
  return queues_[c].waiting.empty() && stamp - last_[c] > timeout;
}

std::int64_t InputQueue::now() const {
  return applied_until_;
}

void InputQueue::clear() {
  collect();
  for (std::size_t channel = 0; channel < queues_.size(); ++channel) {
    taken_[channel] -= queues_[channel].waiting.size();
    queues_[channel].waiting.clear();
    queues_[channel].newest = 0;
  }
  applied_until_ = 0;
  last_ = {};
  moves_ = {};
}

const char* toString(InputChannel channel) {
  switch (channel) {
    case InputChannel::Scope:
      return "scope/measured_js";
    case InputChannel::Overstitch:
      return "overstitch/measured_js";
    case InputChannel::Buttons:
      return "scope/buttons";
    case InputChannel::Pull:
      return "tissue/pull";
  }
  return "";
}

}  // namespace vibe::sim
