#pragma once
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/Joy.h>
#include <vibe_msgs/HapticParameters.h>
#include <vibe_msgs/OperatingState.h>

#include <array>
#include <string>

#include "vibe_hardware/driver/haptic_driver.hpp"
#include "vibe_hardware/driver/overstitch_drive.hpp"
#include "vibe_hardware/driver/scope_joints.hpp"

namespace vibe::hardware {

/// Times of the host's steady clock as stamps of ROS. The stamps of one topic never go back and never repeat, unless
/// the system clock is set back by more than a second.
class StampSource {
 public:
  ros::Time at(double time);  ///< @param time  of steadyTime() [s]

 private:
  ros::Time last_;
};

sensor_msgs::JointState makeScopeJoints(const ScopeJoints& joints, const ros::Time& stamp);
/// Joints of the haptic device, with the commanded torque as effort.
sensor_msgs::JointState makeHapticJoints(const ScopeJoints& joints, const ros::Time& stamp);
sensor_msgs::JointState makeOverstitchJoints(const OverstitchDrive& drive, const ros::Time& stamp);
sensor_msgs::Joy makeButtons(const ScopeButtons& buttons, const ros::Time& stamp);

/// The spring-dampers of the message on the axes of the haptic device; axes without a joint get none.
/// @throws Error with one sentence for a value that is not finite, a negative stiffness or unknown joints
HapticDriver::Targets readHapticParameters(const vibe_msgs::HapticParameters& message, const ScopeJoints& joints);

/// @throws Error as in the simulator: unknown, missing or repeated joints, values that are not finite
OverstitchDrive::Positions readOverstitchJoints(const sensor_msgs::JointState& message);

/// As CRTK has it: DISABLED, ENABLED, PAUSED or FAULT.
std::string operatingState(const DeviceStatistics& device, const HapticStatistics& haptic);

}  // namespace vibe::hardware
