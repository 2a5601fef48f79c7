#include "vibe_hardware/driver/joint_scale.hpp"

namespace vibe {

double jointPosition(const JointScale& joint, double axis_position) {
  return joint.offset + joint.scale * axis_position;
}

double axisPosition(const JointScale& joint, double joint_position) {
  return (joint_position - joint.offset) / joint.scale;
}

double jointEffort(const JointScale& joint, double axis_torque) {
  return axis_torque / joint.scale;
}

vibe_firmware::AxisParameters axisSpring(const JointScale& joint, const JointSpring& spring, double torque_limit) {
  vibe_firmware::AxisParameters axis;
  axis.stiffness = static_cast<float>(joint.scale * joint.scale * spring.stiffness);
  axis.damping = static_cast<float>(joint.scale * joint.scale * spring.damping);
  axis.position = static_cast<float>(axisPosition(joint, spring.position));
  axis.torque = static_cast<float>(joint.scale * spring.effort);
  axis.torque_limit = static_cast<float>(torque_limit);
  return axis;
}

}  // namespace vibe
