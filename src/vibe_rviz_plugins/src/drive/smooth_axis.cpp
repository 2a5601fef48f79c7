#include "drive/smooth_axis.hpp"

#include <algorithm>
#include <cmath>

namespace vibe::rviz_plugins {
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

}  // namespace vibe::rviz_plugins
