#include "trainee/trainee_hand.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "trainee/hand_speed.hpp"
#include "trainee/minimum_jerk.hpp"

namespace vibe {

TraineeHand::TraineeHand(const Model& model, const Skill& skill, std::function<void()> next)
    : model_(model), skill_(skill), next_(std::move(next)) {}

void TraineeHand::perceive(const Observation& seen) {
  if (view_ == nullptr) command_.joints = seen.joints;
  view_ = &seen;
  events_.insert(events_.end(), seen.events.begin(), seen.events.end());
}

void TraineeHand::wait(double seconds) {
  const long steps = std::lround(seconds / model_.scene.step_period);
  for (long k = 0; k < steps; ++k) next_();
}

bool TraineeHand::await(const std::function<bool()>& condition, double patience) {
  const long steps = std::lround(patience / model_.scene.step_period);
  for (long k = 0; k < steps && !condition(); ++k) next_();
  return condition();
}

bool TraineeHand::moveTo(const Joints& joints, double min, const std::function<bool()>& stop) {
  const Joints from = command_.joints;
  Joints to = from;
  for (int j = 0; j < kJointCount; ++j)
    if (std::isfinite(joints[j])) to[j] = joints[j];
  const double duration = std::max(min / skill_.pace, durationOfMotion(from, to, skill_.pace, model_.tool->limits()));
  const long steps = std::max(1L, std::lround(duration / model_.scene.step_period));
  for (long k = 1; k <= steps; ++k) {
    if (stop && stop()) return false;
    const double part = minimumJerk(static_cast<double>(k) / static_cast<double>(steps));
    for (int j = 0; j < kJointCount; ++j) command_.joints[j] = from[j] + part * (to[j] - from[j]);
    next_();
  }
  return true;
}

bool TraineeHand::move(Joint joint, double position, double min, const std::function<bool()>& stop) {
  Joints joints;
  joints.fill(std::numeric_limits<double>::quiet_NaN());
  joints[joint] = position;
  return moveTo(joints, min, stop);
}

void TraineeHand::hold(Button button, double seconds) {
  press(button);
  wait(seconds);
  release(button);
  wait(0.1);  // so that the next press is one of its own
}

const Event* TraineeHand::find(Event::Kind kind) const {
  const auto found =
      std::find_if(events_.begin(), events_.end(), [kind](const Event& event) { return event.kind == kind; });
  return found == events_.end() ? nullptr : &*found;
}

}  // namespace vibe
