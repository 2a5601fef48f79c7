#pragma once
#include <array>
#include <cstdint>

#include "vibe_hardware/crtk/teleop.hpp"

namespace vibe::hardware {

/// Whether the arm is to move the suturing device, and not the scope.
bool wantsDevice(const TeleopMapping& mapping, const TeleopInput& input);

/// The joint of the gripper moves by as much as the gripper, from where it is; the arm is engaged and the angle known.
/// @param dt  since the last step [s]
void moveGripper(const ArmGripper& gripper, const TeleopInput& input, double dt, TeleopState& state);

/// The buttons that count: pressed since the arm may be used, while it moved what the mapping says. By vibe::Button.
/// @param usable  the arm may be used, and it measures
std::array<std::uint8_t, kButtonCount> pressedOf(const TeleopMapping& mapping, const TeleopInput& input, bool usable,
                                                 TeleopState& state);

}  // namespace vibe::hardware
