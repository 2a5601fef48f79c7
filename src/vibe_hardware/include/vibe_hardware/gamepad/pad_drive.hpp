#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <string>

#include "vibe_hardware/gamepad/pad_mapping.hpp"
#include "vibe_hardware/gamepad/pad_state.hpp"

namespace vibe::hardware {

/// What a pad has made of its axes and buttons so far.
struct DriveState {
  std::array<double, kJointCount> joints{};           ///< commanded [m], [rad]
  std::array<std::uint8_t, kButtonCount> buttons{};   ///< 1 while pressed
  std::array<bool, kJointCount> resting{};            ///< the pad does not move the joint at present
  std::array<bool, kJointCount> engaged{};            ///< position mode: the control has picked the joint up
  std::array<double, kJointCount> targets{};          ///< position mode: where the control was; NaN: unknown [m], [rad]
  std::array<std::uint32_t, kButtonCount> presses{};  ///< of the pad's buttons, already used
  /// The same of the buttons that move joints, forwards and backwards.
  std::array<std::array<std::uint32_t, 2>, kJointCount> taps{};
};

/// Deflection of a joint's control after dead zone, exponent and direction, from -1 to 1; 0 if the pad lacks it.
double controlDeflection(const JointMapping& joint, const PadState& pad);

/// The beginning of driving, from where the joints are. What the pad's buttons did before does not count.
DriveState startDrive(const std::array<double, kJointCount>& joints, const PadMapping& mapping, const PadState& pad);

/// One sampling period: pad and mapping move the joints and press the buttons. No input, no clock, no device: the same
/// arguments give the same result.
///   rate mode      joint += deflection * rate * dt
///   position mode  the joint goes to low + (high - low) (deflection + 1) / 2 at its greatest speed. A control that is
///                  elsewhere than its joint picks it up when it comes within 2 % of its range to it, or passes it;
///                  until then the joint stays.
/// A button that was pressed and let go since the last call counts as pressed for this one.
/// Joints never leave their limits and never move faster than theirs.
/// @param dt  time since the last call [s]; more than 0.1 s counts as 0.1 s, so that a pause causes no jump
DriveState advance(const PadMapping& mapping, const ToolLimits& limits, const PadState& pad, DriveState state,
                   double dt);

/// The pad is gone: buttons are released, joints stay, and position controls have to pick their joints up again.
DriveState releaseDrive(DriveState state);

/// Keeps the command near where the simulator has the joints: at most a quarter of a second of greatest speed ahead. A
/// joint that is further away than twice that (after a reset or a load), or that rests there because another node moves
/// it, is taken over from the simulator.
DriveState followJoints(const std::array<double, kJointCount>& measured, const ToolLimits& limits, DriveState state);

/// One sentence that names the position controls that have not picked their joints up and what to do; empty if none.
std::string waitingControls(const PadMapping& mapping, const DriveState& state);

/// One sentence that names the controls that the mapping uses and the pad lacks; empty if none.
std::string missingControls(const PadMapping& mapping, const PadState& pad);

}  // namespace vibe::hardware
