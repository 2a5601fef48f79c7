#include "vibe_operator/drive/scope_drive.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace vibe::operating {

namespace {

constexpr double kPrecision = 1e-10;  // of positions, far below what a joint resolves [m] or [rad]
constexpr int kMostPhases = 8;        // a motion has at most brake, accelerate, cruise, brake, and their roundings

}  // namespace

void SmoothAxis::rest(const AxisLimits& limits, double position) {
  limits_ = limits;
  position_ = std::clamp(position, limits.lower, limits.upper);
  velocity_ = 0;
}

double SmoothAxis::stoppingPoint() const {
  return position_ + velocity_ * std::abs(velocity_) / (2 * limits_.acceleration);
}

void SmoothAxis::advance(double seconds, double goal, double speed) {
  goal = std::clamp(goal, limits_.lower, limits_.upper);
  speed = std::clamp(speed, 0.0, limits_.velocity);
  for (int i = 0; i < kMostPhases && seconds > 0; ++i) seconds -= phase(seconds, goal, speed);
  position_ = std::clamp(position_, limits_.lower, limits_.upper);  // against rounding
}

/// One part of the motion with constant acceleration. @return how long it took, `seconds` at most
double SmoothAxis::phase(double seconds, double goal, double speed) {
  const double spare = goal - stoppingPoint();
  if (std::abs(spare) <= kPrecision) return brake(seconds, goal);
  const double side = spare > 0 ? 1 : -1, a = limits_.acceleration;
  const double towards = side * velocity_;  // velocity and distance in the direction of the goal
  const double distance = side * (goal - position_);
  if (towards > speed) return accelerate(std::min(seconds, (towards - speed) / a), -side * a);
  const double peak = std::sqrt(std::max(0.0, a * distance + 0.5 * towards * towards));
  const double until = (std::min(peak, speed) - towards) / a;
  if (until > 1e-12) return accelerate(std::min(seconds, until), side * a);
  if (towards <= 0) return seconds;  // a speed of 0: waits
  velocity_ = side * std::min(peak, speed);
  return cruise(std::min(seconds, std::abs(spare) / towards));
}

/// Brakes to rest at the goal, which is the stopping point.
double SmoothAxis::brake(double seconds, double goal) {
  const double a = limits_.acceleration, needed = std::abs(velocity_) / a;
  if (needed > seconds) return accelerate(seconds, velocity_ > 0 ? -a : a);
  position_ = goal;
  velocity_ = 0;
  return seconds;
}

double SmoothAxis::accelerate(double seconds, double acceleration) {
  position_ += velocity_ * seconds + 0.5 * acceleration * seconds * seconds;
  velocity_ += acceleration * seconds;
  return seconds;
}

double SmoothAxis::cruise(double seconds) {
  position_ += velocity_ * seconds;
  return seconds;
}

namespace {

// Time from rest to the greatest speed of the URDF; the speeds of the keys are reached sooner. Design choice. [s]
constexpr double kRampTime = 0.3;

}  // namespace

void ScopeDrive::begin(const JointLimits& limits, const Joints& present) {
  limits_ = limits;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const JointLimit& limit = limits[i];
    axes_[i].rest({limit.lower, limit.upper, limit.velocity, limit.velocity / kRampTime}, present[i]);
    goals_[i] = axes_[i].position();
    pressed_[i] = goals_[i];
  }
}

void ScopeDrive::keyDown(int key) {
  const KeyBinding* binding = findBinding(key);
  if (binding != nullptr && down_.insert(key).second) change(*binding, true);
}

void ScopeDrive::keyUp(int key) {
  const KeyBinding* binding = findBinding(key);
  if (binding != nullptr && down_.erase(key) > 0) change(*binding, false);
}

void ScopeDrive::change(const KeyBinding& binding, bool down) {
  if (binding.kind == KeyBinding::Kind::Button) button_changed_(binding.index, down);
  if (binding.kind == KeyBinding::Kind::Gear && down) chosen_ = static_cast<DriveGear>(binding.index);
  if (binding.kind == KeyBinding::Kind::Joint) changeJoint(binding, down);
}

void ScopeDrive::changeJoint(const KeyBinding& binding, bool down) {
  const auto i = static_cast<std::size_t>(binding.index);
  if (down) pressed_[i] = axes_[i].position();
  if (direction(binding.index) != 0) return;
  goals_[i] = axes_[i].stoppingPoint();
  if (down) return;
  const double tap = pressed_[i] + binding.sign * factor() * speeds_.keys[i] * kTap;
  goals_[i] = binding.sign > 0 ? std::max(goals_[i], tap) : std::min(goals_[i], tap);
}

void ScopeDrive::releaseAll() {
  while (!down_.empty()) keyUp(*down_.begin());
  releaseJoints();
}

void ScopeDrive::releaseJoints() {
  for (auto key = down_.begin(); key != down_.end();)
    key = findBinding(*key)->kind == KeyBinding::Kind::Joint ? down_.erase(key) : std::next(key);
  for (std::size_t i = 0; i < axes_.size(); ++i) goals_[i] = axes_[i].stoppingPoint();
}

void ScopeDrive::displace(int joint, double by) {
  const auto i = static_cast<std::size_t>(joint);
  if (direction(joint) != 0 || !std::isfinite(by)) return;
  if (gear() == DriveGear::Slow) by *= speeds_.slow;
  goals_[i] = std::clamp(goals_[i] + by, limits_[i].lower, limits_[i].upper);
}

void ScopeDrive::advance(double seconds) {
  for (int joint = 0; joint < kJointCount; ++joint) advanceJoint(joint, seconds);
}

void ScopeDrive::advanceJoint(int joint, double seconds) {
  const auto i = static_cast<std::size_t>(joint);
  SmoothAxis& axis = axes_[i];
  const int way = direction(joint);
  if (way == 0) return axis.advance(seconds, goals_[i], limits_[i].velocity);
  axis.advance(seconds, way > 0 ? limits_[i].upper : limits_[i].lower, factor() * speeds_.keys[i]);
}

/// Opposite keys cancel.
int ScopeDrive::direction(int joint) const {
  int sum = 0;
  for (const int key : down_) {
    const KeyBinding& binding = *findBinding(key);
    if (binding.kind == KeyBinding::Kind::Joint && binding.index == joint) sum += binding.sign;
  }
  return std::clamp(sum, -1, 1);
}

DriveGear ScopeDrive::gear() const {
  const bool slowed = std::any_of(down_.begin(), down_.end(),
                                  [](int key) { return findBinding(key)->kind == KeyBinding::Kind::SlowDown; });
  return slowed ? DriveGear::Slow : chosen_;
}

double ScopeDrive::factor() const {
  switch (gear()) {
    case DriveGear::Slow:
      return speeds_.slow;
    case DriveGear::Fast:
      return speeds_.fast;
    case DriveGear::Normal:
      break;
  }
  return 1;
}

Joints ScopeDrive::joints() const {
  Joints joints{};
  for (std::size_t i = 0; i < axes_.size(); ++i) joints[i] = axes_[i].position();
  return joints;
}

bool ScopeDrive::atRest() const {
  return std::all_of(axes_.begin(), axes_.end(), [](const SmoothAxis& axis) { return axis.velocity() == 0; });
}

}  // namespace vibe::operating
