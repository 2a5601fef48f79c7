#pragma once
#include <optional>
#include <string>

#include "vibe_core/contact/tool_model.hpp"

namespace vibe {

/// The joint of that name, null without one.
const ToolJoint* findJoint(const ToolModel& tool, const std::string& name);

/// Two bars that are joined by a pin: one turns about the hinge of the needle arm, the other about the needle's point.
struct LinkageTurns {
  double arm = 0;   ///< about needle_arm_hinge, 0 with the arm open [rad]
  double hook = 0;  ///< about needle_hook_turn, 0 with the arm open [rad]
};

/// The turns with which needle_arm_pin and needle_hook_pin are at the same place while needle_driver slides: two
/// circles meet there, on the side on which they meet with the arm open. Where they do not meet, the bars point at each
/// other.
/// @param driver  position of needle_driver [m]
/// @return empty if the URDF has no such bars, or if arm and needle are not carried by the same link
std::optional<LinkageTurns> needleLinkage(const ToolModel& tool, double driver);

}  // namespace vibe
