#pragma once
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/Joy.h>
#include <vibe_msgs/HapticParameters.h>
#include <vibe_msgs/ProcedureEvent.h>

#include <array>
#include <optional>

#include "vibe_core/input/step_input.hpp"
#include "vibe_hardware/gamepad/pad_drive.hpp"
#include "vibe_hardware/gamepad/pad_feedback.hpp"

namespace vibe::hardware {

/// For scope/servo_jp: the joints of the scope as a command.
sensor_msgs::JointState scopeCommand(const DriveState& drive, const ros::Time& stamp);
/// For overstitch/measured_js.
sensor_msgs::JointState overstitchCommand(const DriveState& drive, const ros::Time& stamp);
/// For scope/buttons.
sensor_msgs::Joy buttonCommand(const DriveState& drive, const ros::Time& stamp);

/// The seven joints of joint_states, by name. Nothing if one is missing or not finite.
std::optional<std::array<double, kJointCount>> readJointStates(const sensor_msgs::JointState& message);
/// Stiffness and equilibrium of the scope's joints.
JointSprings readJointSprings(const vibe_msgs::HapticParameters& message);
/// What an event feels like; nothing for those that are not felt.
std::optional<PadPulse> pulseOf(const vibe_msgs::ProcedureEvent& event);

}  // namespace vibe::hardware
