#include "vibe_hardware/driver/joint_scale.hpp"

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

}  // namespace vibe::hardware
