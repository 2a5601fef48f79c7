#include "vibe_hardware/driver/joint_scale.hpp"

#include <algorithm>
#include <cmath>

#include "vibe_firmware/core/passivity.hpp"

namespace vibe::hardware {

double jointPosition(const JointScale& joint, double axis_position) {
  return joint.offset + joint.scale * axis_position;
}

double axisPosition(const JointScale& joint, double joint_position) {
  return (joint_position - joint.offset) / joint.scale;
}

double jointEffort(const JointScale& joint, double axis_torque) {
  return axis_torque / joint.scale;
}

JointSpring springOnAxis(const JointScale& joint, const JointSpring& spring) {
  JointSpring axis;
  axis.position = axisPosition(joint, spring.position);
  axis.velocity = spring.velocity / joint.scale;
  axis.effort = joint.scale * spring.effort;
  axis.stiffness = joint.scale * joint.scale * spring.stiffness;
  axis.damping = joint.scale * joint.scale * spring.damping;
  return axis;
}

vibe_firmware::AxisParameters axisSpring(const JointScale& joint, const JointSpring& spring, double torque_limit) {
  const JointSpring on_axis = springOnAxis(joint, spring);
  vibe_firmware::AxisParameters axis;
  axis.stiffness = static_cast<float>(on_axis.stiffness);
  axis.damping = static_cast<float>(on_axis.damping);
  axis.position = static_cast<float>(on_axis.position);
  axis.torque = static_cast<float>(on_axis.effort + on_axis.damping * on_axis.velocity);
  axis.torque_limit = static_cast<float>(torque_limit);
  return axis;
}

namespace {

using vibe_firmware::AxisConfig;
using vibe_firmware::AxisParameters;
using vibe_firmware::Refusal;

constexpr float kBelowLimit = 0.9999F;  // the limits are exclusive, and the device computes with floats

/// Moves the point about which the spring is stated along its own line to where the torque equals the limit.
void limitTorque(double limit, double& position, double& torque, double stiffness) {
  const double excess = torque - std::clamp(torque, -limit, limit);
  torque -= excess;
  if (excess != 0 && stiffness > 0) position += excess / stiffness;
}

}  // namespace

PassiveSpring passiveSpring(const AxisConfig& axis, const JointSpring& spring) {
  const auto lower = [](double wanted, float limit) {
    return wanted <= static_cast<double>(limit) ? wanted : static_cast<double>(kBelowLimit * limit);
  };
  PassiveSpring result;
  const double stiffness = lower(spring.stiffness, vibe_firmware::maxStiffness(axis, 0));
  const float largest_damping = vibe_firmware::maxDamping(axis, static_cast<float>(stiffness));
  const double damping = lower(spring.damping, largest_damping);
  result.clamped = stiffness < spring.stiffness || damping < spring.damping;

  const auto limit = static_cast<double>(axis.torque_limit);
  double position = spring.position;
  double torque = spring.effort + damping * spring.velocity;
  result.clamped |= std::abs(torque) > limit;
  limitTorque(limit, position, torque, stiffness);
  AxisParameters& p = result.parameters;
  p.stiffness = static_cast<float>(stiffness);
  p.damping = static_cast<float>(damping);
  p.position = static_cast<float>(position);
  p.torque = static_cast<float>(torque);
  p.torque_limit = axis.torque_limit;
  if (vibe_firmware::validate(axis, p).refusal == Refusal::None) return result;
  // What remains is rounding at the border, or a position that no encoder reaches: a spring that far away is no spring.
  result.clamped = true;
  p.stiffness *= kBelowLimit;
  p.damping *= kBelowLimit;
  p.torque *= kBelowLimit;
  if (vibe_firmware::validate(axis, p).refusal != Refusal::None) p = {};
  return result;
}

}  // namespace vibe::hardware
