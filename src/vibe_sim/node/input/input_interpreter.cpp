#include "input/input_interpreter.hpp"

#include <algorithm>
#include <cmath>

#include "input/target_checks.hpp"
#include "input/tip_velocity.hpp"
#include "vibe_core/constraints/pull_patch.hpp"
#include "vibe_core/files/number_text.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe::sim {
namespace {

constexpr double kPeakSpeed = 1.875;  // of the path of least jerk, over its mean speed
constexpr double kLongestStep = 0.1;  // of a velocity, such as the first step of all [s]
constexpr double kFadesOver = 3;      // a velocity fades over the life divided by that
constexpr double kReached = 5e-3;     // of the tip from its target: close enough to say nothing [m]

/// Share of the way at a share of the time.
double leastJerk(double s) {
  return s * s * s * (10 - 15 * s + 6 * s * s);
}

std::string beyondReach(const std::string& topic, const Eigen::Vector3d& target, const Model& model,
                        const StepInput& input) {
  std::vector<Eigen::Isometry3d> poses;
  model.tool->forwardKinematics(input.joints, poses);
  const double miss = (poses[model.tip_link].translation() - target).norm();
  if (miss < kReached) return "";
  return topic + " asks for a place that the scope misses by " + std::to_string(std::lround(1e3 * miss)) +
         " mm; it goes as near as it can.";
}

std::string noScope(const InputSample& sample, const Model& model) {
  return topicOf(sample) + " has no effect because the scene '" + model.scene.name +
         "' has no scope; load a scene with one.";
}

std::string reachTip(const InputSample& sample, const Model& model, StepInput& input) {
  if (!model.tool) return noScope(sample, model);
  const bool in_world = sample.target == ScopeTarget::TipInWorld;
  const Eigen::Isometry3d pose = in_world ? model.tool_base.inverse() * sample.tip_pose : sample.tip_pose;
  input.joints = model.tool->inverseKinematics(pose, input.joints);
  return beyondReach(topicOf(sample), pose.translation(), model, input);
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
    case InputChannel::SuturingDevice:
      std::copy(sample.joints.begin() + kScopeJointCount, sample.joints.end(), input.joints.begin() + kScopeJointCount);
      break;
    case InputChannel::Pull:
      return applyPull(sample, model, input);
    case InputChannel::Buttons:
      break;
  }
  return "";
}

std::string secondsText(std::int64_t ns) {
  return std::to_string(ns / 1'000'000'000) + " s";
}

/// Without a sender, nobody could be named.
std::string overtakenSentence(const OvertakenSample& overtaken) {
  const InputSample& sample = overtaken.sample;
  if (sample.sender == nullptr) return "";
  return "A message on " + sample.sender->topic + " from " + sample.sender->node + " is ignored: its stamp is " +
         formatted("%.3g s", 1e-9 * static_cast<double>(overtaken.newest - sample.stamp)) +
         " before that of one of the same node that is used already; send messages in the order of their stamps.";
}

/// @return a sentence if there was a pull
std::string letGo(StepInput& input) {
  if (input.pull_particle < 0) return "";
  input.pull_particle = -1;
  input.pull_target.setZero();
  return "The hand on tissue/pull has been silent for " + secondsText(kPullTimeout) +
         " and lets go; send its target again while it holds.";
}

}  // namespace

std::string releaseSilentButtons(const DueInput& due, StepInput& input) {
  if (!due.isSilent(InputChannel::Buttons, kButtonTimeout)) return "";
  std::string names;
  for (int b = 0; b < kButtonCount; ++b) {
    if (!input.buttons[b]) continue;
    names += (names.empty() ? "" : ", ") + std::string(kButtonNames[b]);
    input.buttons[b] = 0;
  }
  if (names.empty()) return "";
  return "No message has come on scope/buttons for " + secondsText(kButtonTimeout) +
         ", so the scope stays where it is and these buttons are released: " + names +
         "; send pressed buttons at 10 Hz.";
}

JointMove::JointMove(const JointArray& start, const JointArray& goal, int first, int count,
                     const std::array<JointLimits, kJointCount>& limits, std::int64_t begin)
    : start_(start), first_(first), count_(count), begin_(begin) {
  for (int j = first_; j < first_ + count_; ++j) {
    way_[j] = std::clamp(goal[j], limits[j].lower, limits[j].upper) - start_[j];
    const double seconds = kPeakSpeed * std::abs(way_[j]) / limits[j].velocity;
    duration_ = std::max(duration_, static_cast<std::int64_t>(std::ceil(1e9 * seconds)));
  }
  duration_ = std::max<std::int64_t>(duration_, 1);  // a move to where the joints are is busy for a step as well
}

void JointMove::apply(std::int64_t stamp, JointArray& joints) const {
  const double passed = static_cast<double>(stamp - begin_);
  const double s = stamp >= end() ? 1 : std::max(0.0, passed / static_cast<double>(duration_));
  for (int j = first_; j < first_ + count_; ++j) joints[j] = start_[j] + leastJerk(s) * way_[j];
}

std::vector<std::string> InputInterpreter::interpret(const DueInput& due, const Model& model, StepInput& input,
                                                     const std::optional<JointArray>& hand) {
  if (due.stamp < due.since) endMoves();
  const JointArray start = hand.value_or(input.joints);
  std::vector<std::string> sentences;
  const auto say = [&sentences](std::string sentence) {
    if (!sentence.empty()) sentences.push_back(std::move(sentence));
  };
  for (const std::optional<OvertakenSample>& each : due.overtaken)
    if (each) say(overtakenSentence(*each));
  for (const InputSample& sample : due.samples)
    if (sample.channel == InputChannel::Buttons)
      press(sample.buttons, input.buttons);
    else
      say(applySample(sample, due, model, start, input));
  changeButtons(input.buttons);
  applyMoves(due.stamp, input.joints);
  if (twist_ && model.tool) say(applyTwist(due, model, start, input.joints));
  if (due.isSilent(InputChannel::Pull, kPullTimeout)) say(letGo(input));
  return sentences;
}

// Presses within a step become one, so that no button lags behind: of three changes, a pressed button still owes all.
void InputInterpreter::press(const Buttons& buttons, const Buttons& now) {
  for (std::size_t b = 0; b < buttons.size(); ++b) {
    const bool last = (now[b] != 0) != (owed_[b] % 2 != 0);
    const int most = now[b] != 0 ? 3 : 2;
    if ((buttons[b] != 0) != last) owed_[b] = owed_[b] < most ? owed_[b] + 1 : most - 1;
  }
}

void InputInterpreter::changeButtons(Buttons& buttons) {
  for (std::size_t b = 0; b < buttons.size(); ++b) {
    if (owed_[b] == 0) continue;
    buttons[b] = buttons[b] != 0 ? 0 : 1;
    --owed_[b];
  }
}

std::string InputInterpreter::applySample(const InputSample& sample, const DueInput& due, const Model& model,
                                          const JointArray& hand, StepInput& input) {
  const std::string refusal = refusalOf(sample, model);
  if (!refusal.empty()) return refusal;
  const auto channel = static_cast<std::size_t>(sample.channel);
  std::string sentence;
  if (channel < drivers_.size() && !drivers_[channel].obeys(sample, hand, sentence)) return sentence;
  if (sentence.empty()) sentence = beyondLimits(sample, model);
  moves_[channel].reset();
  if (sample.channel == InputChannel::Scope) twist_.reset();
  if (sample.target == ScopeTarget::VelocityInWorld || sample.target == ScopeTarget::VelocityInBase)
    return sentence + beginTwist(sample, due, model);
  const std::string miss = sample.move ? beginMove(sample, due.stamp, model, hand) : applyValues(sample, model, input);
  return sentence.empty() ? miss : sentence;
}

std::string InputInterpreter::beginMove(const InputSample& sample, std::int64_t stamp, const Model& model,
                                        const JointArray& hand) {
  const bool scope = sample.channel == InputChannel::Scope;
  if (!model.tool) return noScope(sample, model);
  StepInput goal;
  goal.joints = sample.target == ScopeTarget::Joints ? sample.joints : hand;
  const std::string sentence = sample.target == ScopeTarget::Joints ? "" : reachTip(sample, model, goal);
  const int first = scope ? 0 : kScopeJointCount, count = scope ? kScopeJointCount : kJointCount - kScopeJointCount;
  moves_[static_cast<std::size_t>(sample.channel)].emplace(hand, goal.joints, first, count, model.tool->limits(),
                                                           stamp);
  return sentence;
}

// A stamp that is not after the last step is none, or late: the velocity counts as of now.
std::string InputInterpreter::beginTwist(const InputSample& sample, const DueInput& due, const Model& model) {
  if (!model.tool) return noScope(sample, model);
  twist_ = {sample.tip_twist, sample.stamp > due.since ? sample.stamp : due.stamp};
  if (sample.target == ScopeTarget::VelocityInWorld) return "";
  twist_->velocity.head<3>() = model.tool_base.linear() * sample.tip_twist.head<3>();
  twist_->velocity.tail<3>() = model.tool_base.linear() * sample.tip_twist.tail<3>();
  return "";
}

std::string InputInterpreter::applyTwist(const DueInput& due, const Model& model, const JointArray& hand,
                                         JointArray& joints) {
  const Twist twist = *twist_;
  const double age = static_cast<double>(due.stamp - twist.begin), life = static_cast<double>(velocity_life_);
  const double share = std::clamp(kFadesOver * (1 - age / life), 0.0, 1.0);
  const double dt = std::clamp(1e-9 * static_cast<double>(due.stamp - due.since), 0.0, kLongestStep);
  const JointArray after = afterTwist(model, hand, share * twist.velocity, dt);
  std::copy_n(after.begin(), kScopeJointCount, joints.begin());
  if (share > 0) return "";
  twist_.reset();
  if (twist.velocity.isZero()) return "";
  return formatted(
      "scope/servo_cv has been silent for %.2g s, so the scope has stopped; its sender may hang or be slow: "
      "send a velocity at 10 Hz while it is to last.",
      1e-9 * age);
}

void InputInterpreter::applyMoves(std::int64_t stamp, JointArray& joints) {
  for (std::optional<JointMove>& move : moves_) {
    if (!move) continue;
    move->apply(stamp, joints);
    if (stamp >= move->end()) move.reset();
  }
}

}  // namespace vibe::sim
