#include "vibe_hardware/gamepad/pad_feedback.hpp"

#include <linux/input-event-codes.h>

#include <algorithm>
#include <cmath>

namespace vibe::hardware {
namespace {

constexpr double kUpdatePeriod = 0.02;    // 50 Hz
constexpr double kForcePatience = 0.25;   // [s]
constexpr double kSpringPatience = 0.1;   // [s]
constexpr double kSpringFade = 0.1;       // [s]
constexpr double kRumbleRefresh = 0.25;   // an effect of the kernel ends after half a second [s]
constexpr double kNoticeable = 1.0 / 64;  // smaller changes are not sent

struct PulseShape {
  double level, seconds;
};

PulseShape shapeOf(PadPulse pulse) {
  switch (pulse) {
    case PadPulse::Contact:
      return {0.4, 0.08};
    case PadPulse::Grab:
      return {0.7, 0.2};
    case PadPulse::Bite:
      return {1.0, 0.3};
    case PadPulse::Failure:
      return {1.0, 0.6};
  }
  return {0, 0};
}

bool differs(double a, double b) {
  return std::abs(a - b) > kNoticeable || ((a == 0) != (b == 0));
}

}  // namespace

void PadFeedback::setForce(double now, double force) {
  if (!std::isfinite(force)) return;
  force_ = std::abs(force);
  force_time_ = now;
}

void PadFeedback::pulse(double now, PadPulse pulse) {
  const PulseShape shape = shapeOf(pulse);
  pulse_level_ = now < pulse_end_ ? std::max(pulse_level_, shape.level) : shape.level;
  pulse_end_ = std::max(pulse_end_, now + shape.seconds);
}

void PadFeedback::setSprings(double now, const JointSprings& springs) {
  for (std::size_t i = 0; i < kScopeJointCount; ++i)
    if (!std::isfinite(springs.stiffness[i]) || !std::isfinite(springs.equilibrium[i])) return;
  joints_ = springs;
  joints_time_ = now;
}

double PadFeedback::strongLevel(double now) const {
  const double full = mapping_.feedback.rumble_force;
  if (full <= 0 || now - force_time_ > kForcePatience) return 0;
  return std::min(force_ / full, 1.0);
}

double PadFeedback::weakLevel(double now) const {
  return mapping_.feedback.rumble_force > 0 && now < pulse_end_ ? pulse_level_ : 0;
}

std::array<StickSpring, 2> PadFeedback::springs(double now) const {
  std::array<StickSpring, 2> result{};
  const double fade = std::clamp(1 - (now - joints_time_ - kSpringPatience) / kSpringFade, 0.0, 1.0);
  if (!joints_.touching || fade <= 0) return result;
  for (std::size_t i = 0; i < kScopeJointCount; ++i) {
    const JointMapping& joint = mapping_.joints[i];
    const bool is_stick = joint.forward == ABS_X || joint.forward == ABS_Y;
    if (joint.mode != JointMapping::Mode::Position || joint.full_effort <= 0 || !is_stick) continue;
    const double half = 0.5 * (joint.high - joint.low);
    const double centre = (joints_.equilibrium[i] - joint.low) / half - 1;
    StickSpring& spring = result[joint.forward == ABS_X ? 0 : 1];
    spring.centre = std::clamp(joint.reversed ? -centre : centre, -1.0, 1.0);
    spring.coefficient = fade * std::clamp(joints_.stiffness[i] * half / joint.full_effort, 0.0, 1.0);
  }
  return result;
}

void PadFeedback::update(double now, PadMotors& motors) {
  if (now - last_update_ < kUpdatePeriod) return;
  last_update_ = now;
  if (motors.hasRumble()) updateRumble(now, motors);
  if (motors.hasSpring()) updateSprings(now, motors);
}

void PadFeedback::updateRumble(double now, PadMotors& motors) {
  const std::array<double, 2> levels{strongLevel(now), weakLevel(now)};
  const bool changed = differs(levels[0], sent_levels_[0]) || differs(levels[1], sent_levels_[1]);
  const bool ends = (levels[0] > 0 || levels[1] > 0) && now - last_rumble_ > kRumbleRefresh;
  if (!changed && !ends) return;
  motors.rumble(levels[0], levels[1]);
  sent_levels_ = levels;
  last_rumble_ = now;
}

void PadFeedback::updateSprings(double now, PadMotors& motors) {
  const std::array<StickSpring, 2> wanted = springs(now);
  bool changed = false;
  for (std::size_t axis = 0; axis < 2; ++axis)
    changed = changed || differs(wanted[axis].centre, sent_springs_[axis].centre) ||
              differs(wanted[axis].coefficient, sent_springs_[axis].coefficient);
  if (!changed) return;
  motors.spring(wanted);
  sent_springs_ = wanted;
}

void PadFeedback::forgetPad() {
  sent_levels_ = {};
  sent_springs_ = {};
}

}  // namespace vibe::hardware
