#include "gamepad_messages.hpp"

#include <algorithm>
#include <cmath>

namespace vibe::hardware {
namespace {

sensor_msgs::JointState jointMessage(const DriveState& drive, const ros::Time& stamp, int first, int last) {
  sensor_msgs::JointState message;
  message.header.stamp = stamp;
  message.name.assign(kJointNames.begin() + first, kJointNames.begin() + last);
  message.position.assign(drive.joints.begin() + first, drive.joints.begin() + last);
  return message;
}

}  // namespace

sensor_msgs::JointState scopeCommand(const DriveState& drive, const ros::Time& stamp) {
  return jointMessage(drive, stamp, 0, kScopeJointCount);
}

sensor_msgs::JointState overstitchCommand(const DriveState& drive, const ros::Time& stamp) {
  return jointMessage(drive, stamp, kScopeJointCount, kJointCount);
}

sensor_msgs::Joy buttonCommand(const DriveState& drive, const ros::Time& stamp) {
  sensor_msgs::Joy message;
  message.header.stamp = stamp;
  message.buttons.assign(drive.buttons.begin(), drive.buttons.end());
  return message;
}

std::optional<std::array<double, kJointCount>> readJointStates(const sensor_msgs::JointState& message) {
  std::array<double, kJointCount> joints{};
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const auto found = std::find(message.name.begin(), message.name.end(), kJointNames[i]);
    const auto index = static_cast<std::size_t>(found - message.name.begin());
    if (index >= message.position.size() || !std::isfinite(message.position[index])) return std::nullopt;
    joints[i] = message.position[index];
  }
  return joints;
}

JointSprings readJointSprings(const vibe_msgs::HapticParameters& message) {
  JointSprings springs;
  springs.touching = message.touching;
  for (std::size_t i = 0; i < kScopeJointCount; ++i) {
    const auto found = std::find(message.joint_name.begin(), message.joint_name.end(), kJointNames[i]);
    const auto index = static_cast<std::size_t>(found - message.joint_name.begin());
    if (index >= message.joint_stiffness.size()) continue;
    springs.stiffness[i] = message.joint_stiffness[index];
    springs.equilibrium[i] = message.joint_equilibrium[index];
  }
  return springs;
}

std::optional<PadPulse> pulseOf(const vibe_msgs::ProcedureEvent& event) {
  using vibe_msgs::ProcedureEvent;
  switch (event.kind) {
    case ProcedureEvent::CONTACT_BEGIN:
      return PadPulse::Contact;
    case ProcedureEvent::GRAB:
    case ProcedureEvent::HELIX_TURNED:
      return PadPulse::Grab;
    case ProcedureEvent::PIERCED:
    case ProcedureEvent::BITE:
      return PadPulse::Bite;
    case ProcedureEvent::GRAB_MISSED:
    case ProcedureEvent::SLIP:
    case ProcedureEvent::REJECTED:
    case ProcedureEvent::BITE_MISSED:
    case ProcedureEvent::TEAR_OUT:
    case ProcedureEvent::THREAD_BROKE:
      return PadPulse::Failure;
    default:
      return std::nullopt;
  }
}

}  // namespace vibe::hardware
