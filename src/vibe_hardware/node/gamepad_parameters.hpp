#pragma once
#include <ros/node_handle.h>

#include <string>

#include "vibe_hardware/gamepad/pad_link.hpp"
#include "vibe_hardware/gamepad/pad_mapping.hpp"

namespace vibe::hardware {

/// Private parameters of gamepad_node.
struct GamepadParameters {
  std::string mapping = "package://vibe_hardware/config/gamepads/two_stick.yaml";
  std::string pad;     ///< path, or part of the name or phys; empty: the first gamepad
  std::string replay;  ///< a recorded pad session to play instead; empty: none
  std::string record;  ///< where to record the pad; empty: nowhere
  double rate = 100;   ///< of the published joints [Hz]
};

/// @throws Error for a parameter that is unknown or wrong
GamepadParameters readGamepadParameters(const ros::NodeHandle& private_handle);

/// Limits of the tool from the parameter robot_description, or from the package's URDF if it is not set.
ToolLimits toolLimitsOf(const ros::NodeHandle& handle);

/// The pad, or the recording, that the parameters ask for. @throws Error for a recording that cannot be read
PadLink makePadLink(const GamepadParameters& parameters);

}  // namespace vibe::hardware
