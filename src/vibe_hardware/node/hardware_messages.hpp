#pragma once

#include <array>
#include <optional>
#include <string>

#include <diagnostic_updater/diagnostic_updater.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/Joy.h>
#include <vibe_msgs/HapticParameters.h>
#include <vibe_msgs/OperatingState.h>
#include <vibe_msgs/ProcedureEvent.h>

#include "vibe_core/input/step_input.hpp"
#include "vibe_hardware/driver/device_driver.hpp"
#include "vibe_hardware/driver/haptic_driver.hpp"
#include "vibe_hardware/driver/scope_joints.hpp"
#include "vibe_hardware/gamepad/pad_drive.hpp"
#include "vibe_hardware/gamepad/pad_feedback.hpp"

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
sensor_msgs::JointState makeSuturingDeviceJoints(const SuturingDeviceDrive& drive, const ros::Time& stamp);
/// For scope/buttons. @param pressed  by vibe::Button; 1 while pressed
sensor_msgs::Joy makeButtons(const std::array<std::uint8_t, kButtonCount>& pressed, const ros::Time& stamp);

/// The spring-dampers of the message on the axes of the haptic device; axes without a joint get none.
/// @throws Error with one sentence for a value that is not finite, a negative stiffness or unknown joints
HapticDriver::Targets readHapticParameters(const vibe_msgs::HapticParameters& message, const ScopeJoints& joints);

/// The spring-damper of a joint in the message. @throws Error as above
JointSpring readSpring(const vibe_msgs::HapticParameters& message, const std::string& joint);

/// @throws Error as in the simulator: unknown, missing or repeated joints, values that are not finite
SuturingDeviceDrive::Positions readSuturingDeviceJoints(const sensor_msgs::JointState& message);

/// As CRTK has it: DISABLED, ENABLED, PAUSED or FAULT.
std::string operatingState(const DeviceStatistics& device, const HapticStatistics& haptic);

/// For scope/servo_jp: the joints of the scope as a command.
sensor_msgs::JointState scopeCommand(const DriveState& drive, const ros::Time& stamp);
/// For suturing_device/input/joint_states.
sensor_msgs::JointState suturingDeviceCommand(const DriveState& drive, const ros::Time& stamp);

/// Values of a message for `count` joints in the order of vibe::Joint from `first` on. `joints` stay as they are if one
/// of them is missing or not finite. @return whether all are there
bool readJoints(const sensor_msgs::JointState& message, int first, int count, std::array<double, kJointCount>& joints);
/// Stiffness and equilibrium of the scope's joints.
JointSprings readJointSprings(const vibe_msgs::HapticParameters& message);
/// What an event feels like; nothing for those that are not felt.
std::optional<PadPulse> pulseOf(const vibe_msgs::ProcedureEvent& event);

/// Limits of the tool from the parameter robot_description, or from the package's URDF if it is not set.
ToolLimits toolLimitsOf(const ros::NodeHandle& handle);

/// What a device's entry on /diagnostics compares with its last one.
struct DiagnosticMemory {
  StreamCounts counts;
  HapticStatistics haptic;
};

/// Fills the entry of a device: ERROR if it is unusable or silent; WARN if it is absent, or if since the last entry
/// reports were lost or wrong or parameters refused, or the rate is low.
/// @param haptic           null for the input device
/// @param rejected         messages on haptic/parameters that could not be used
void fillDiagnostics(const DeviceStatistics& device, const HapticStatistics* haptic, std::uint64_t rejected,
                     DiagnosticMemory& memory, diagnostic_updater::DiagnosticStatusWrapper& status);

}  // namespace vibe::hardware
