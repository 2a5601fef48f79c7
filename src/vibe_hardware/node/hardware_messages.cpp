#include "hardware_messages.hpp"

#include <algorithm>
#include <cmath>

#include "vibe_core/common/error.hpp"
#include "vibe_core/common/step_timer.hpp"

namespace vibe::hardware {
namespace {

const ros::Duration kLeast(0, 1000);  // between stamps
const ros::Duration kSetBack(1);      // more than this is a clock that was set

/// Where a name stands in a message. @throws Error if it is missing or there twice
std::size_t placeOf(const std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) throw Error("joint '" + name + "' is missing; send all joints.");
  if (std::find(found + 1, names.end(), name) != names.end()) {
    throw Error("joint '" + name + "' is there twice; send each once.");
  }
  return static_cast<std::size_t>(found - names.begin());
}

void checkFinite(double value, const std::string& what) {
  if (!std::isfinite(value)) throw Error(what + " is not finite; send finite numbers.");
}

JointSpring readSpring(const vibe_msgs::HapticParameters& message, const std::string& joint) {
  const std::size_t i = placeOf(message.joint_name, joint);
  if (i >= message.joint_position.size()) throw Error("joint '" + joint + "' has no values; send four joints.");
  JointSpring spring;
  spring.position = message.joint_position[i];
  spring.velocity = message.joint_velocity[i];
  spring.effort = message.joint_effort[i];
  spring.stiffness = message.joint_stiffness[i];
  spring.damping = message.joint_damping[i];
  checkFinite(spring.position, "joint_position of " + joint);
  checkFinite(spring.velocity, "joint_velocity of " + joint);
  checkFinite(spring.effort, "joint_effort of " + joint);
  checkFinite(spring.stiffness, "joint_stiffness of " + joint);
  checkFinite(spring.damping, "joint_damping of " + joint);
  if (spring.stiffness < 0 || spring.damping < 0) {
    throw Error("stiffness or damping of " + joint + " is negative; send values of at least 0.");
  }
  return spring;
}

}  // namespace

ros::Time StampSource::at(double time) {
  ros::Time stamp = ros::Time::now() - ros::Duration(steadyTime() - time);
  if (stamp < last_ + kLeast && stamp > last_ - kSetBack) stamp = last_ + kLeast;
  last_ = stamp;
  return stamp;
}

sensor_msgs::JointState makeScopeJoints(const ScopeJoints& joints, const ros::Time& stamp) {
  sensor_msgs::JointState message;
  message.header.stamp = stamp;
  message.name.assign(kJointNames.begin(), kJointNames.begin() + kScopeJointCount);
  message.position.assign(joints.positions().begin(), joints.positions().end());
  return message;
}

sensor_msgs::JointState makeHapticJoints(const ScopeJoints& joints, const ros::Time& stamp) {
  sensor_msgs::JointState message;
  message.header.stamp = stamp;
  for (int axis = 0; axis < vibe_firmware::kAxisCount; ++axis) {
    const int joint = joints.calibration().jointOf(DeviceKind::Haptic, axis);
    if (joint < 0) continue;
    message.name.emplace_back(kJointNames[static_cast<std::size_t>(joint)]);
    message.position.push_back(joints.positions()[static_cast<std::size_t>(joint)]);
    message.effort.push_back(joints.effort(joint));
  }
  return message;
}

sensor_msgs::JointState makeOverstitchJoints(const OverstitchDrive& drive, const ros::Time& stamp) {
  sensor_msgs::JointState message;
  message.header.stamp = stamp;
  message.name.assign(kJointNames.begin() + kScopeJointCount, kJointNames.end());
  message.position.assign(drive.positions().begin(), drive.positions().end());
  return message;
}

sensor_msgs::Joy makeButtons(const ScopeButtons& buttons, const ros::Time& stamp) {
  sensor_msgs::Joy message;
  message.header.stamp = stamp;
  message.buttons.assign(buttons.pressed().begin(), buttons.pressed().end());
  return message;
}

HapticDriver::Targets readHapticParameters(const vibe_msgs::HapticParameters& message, const ScopeJoints& joints) {
  HapticDriver::Targets targets{};
  for (int axis = 0; axis < vibe_firmware::kAxisCount; ++axis) {
    const int joint = joints.calibration().jointOf(DeviceKind::Haptic, axis);
    if (joint < 0) continue;
    const JointSpring spring = readSpring(message, kJointNames[static_cast<std::size_t>(joint)]);
    targets[static_cast<std::size_t>(axis)] = springOnAxis(joints.scale(joint), spring);
  }
  return targets;
}

OverstitchDrive::Positions readOverstitchJoints(const sensor_msgs::JointState& message) {
  if (message.name.size() != message.position.size()) throw Error("names and positions differ in number.");
  OverstitchDrive::Positions positions{};
  for (std::size_t j = 0; j < positions.size(); ++j) {
    const std::string name = kJointNames[kScopeJointCount + j];
    positions[j] = message.position[placeOf(message.name, name)];
    checkFinite(positions[j], "the position of " + name);
  }
  return positions;
}

std::string operatingState(const DeviceStatistics& device, const HapticStatistics& haptic) {
  if (device.state == LinkState::Absent) return "DISABLED";
  constexpr int kFaults = vibe_firmware::kEncoderFault | vibe_firmware::kDriveFault;
  if (device.state != LinkState::Running || (device.flags & kFaults) != 0) return "FAULT";
  return haptic.in_force ? "ENABLED" : "PAUSED";
}

}  // namespace vibe::hardware
