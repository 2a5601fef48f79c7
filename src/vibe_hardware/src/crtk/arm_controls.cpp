#include "crtk/arm_controls.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vibe::hardware {
namespace {

constexpr double kGripperTime = 0.2;             // in which a hand closes the gripper at the fastest [s]; design choice
constexpr double kGripperCatchUp = 1;            // in which it takes its joint along at the end [s]; design choice
constexpr double kGripperStep = 5e-3;            // of these motions at most [s]
constexpr double kGripperJump = 0.3;             // of its way at once: no motion of a hand; design choice
constexpr double kGripperEnd = 0.1;              // of its way is near an end; design choice
constexpr double kPinch = 0.25, kUnpinch = 0.5;  // of its way: it presses its button, and lets it go; design choice

/// From 0, closed, to 1.
double opening(const ArmGripper& gripper, double angle) {
  return std::clamp((angle - gripper.closed) / (gripper.open - gripper.closed), 0.0, 1.0);
}

/// Whether the gripper presses its button: closed enough, until it has opened wide enough. One that is not known may
/// be.
std::uint8_t pinches(const ArmGripper& gripper, const TeleopInput& input, bool was) {
  return !input.gripper || opening(gripper, *input.gripper) < (was ? kUnpinch : kPinch) ? 1 : 0;
}

}  // namespace

bool wantsDevice(const TeleopMapping& mapping, const TeleopInput& input) {
  return mapping.device_only || (!mapping.device.topic.empty() && input.device != mapping.device.reversed);
}

/// The joint of the gripper moves by as much as the gripper. What it was apart is used up at the ends of its way: there
/// the joint stays while the gripper comes, and a gripper that comes to an end from the middle takes the joint along,
/// as long as the tool obeys.
void moveGripper(const ArmGripper& gripper, const TeleopInput& input, double dt, TeleopState& state) {
  const double way = gripper.at_open - gripper.at_closed;
  const double share = opening(gripper, *input.gripper);
  const double wanted = gripper.at_closed + share * way;
  if (!state.gripper || std::abs(wanted - *state.gripper) > kGripperJump * std::abs(way))
    state.gripper = wanted, state.gripper_moved = false;
  const double step = std::min(dt, kGripperStep) * std::abs(way);
  const double motion = std::clamp(wanted - *state.gripper, -step / kGripperTime, step / kGripperTime);
  const auto j = static_cast<std::size_t>(gripper.joint);
  double& joint = state.joints[j];
  const auto [low, high] = std::minmax({gripper.at_closed, gripper.at_open, joint});
  joint = std::clamp(joint + motion, low, high);
  *state.gripper += motion;
  state.gripper_moved |= share > kGripperEnd && share < 1 - kGripperEnd;
  const bool obeyed = !input.live || std::abs(input.joints[j] - joint) < unnoticed(gripper.joint);
  if (state.gripper_moved && (share == 0 || share == 1) && obeyed)
    joint += std::clamp(wanted - joint, -step / kGripperCatchUp, step / kGripperCatchUp);
}

/// Those that count: pressed since the arm may be used, while it moved what the mapping says.
std::array<std::uint8_t, kButtonCount> pressedOf(const TeleopMapping& mapping, const TeleopInput& input, bool usable,
                                                 TeleopState& state) {
  std::array<std::uint8_t, kButtonCount> down = input.buttons;
  if (mapping.gripper && mapping.gripper->button >= 0) {
    const auto b = static_cast<std::size_t>(mapping.gripper->button);
    down[b] = pinches(*mapping.gripper, input, (state.old_press[b] | state.held[b]) != 0);
    if (!input.gripper) state.old_press[b] = 1;
  }
  const auto elsewhere = wantsDevice(mapping, input) ? ArmButton::While::Scope : ArmButton::While::Device;
  for (std::size_t b = 0; b < down.size(); ++b) {
    const ArmButton& control = mapping.buttons[b];
    state.old_press[b] &= down[b];
    if (!usable || (control.during == elsewhere && state.held[b] == 0)) state.old_press[b] = down[b];
    const std::uint8_t before = std::exchange(state.held[b], down[b] & ~state.old_press[b]);
    if (!input.ready) state.switched_on[b] = 0;
    if (before < state.held[b]) state.switched_on[b] ^= 1;
    down[b] = control.toggle ? state.switched_on[b] : state.held[b];
  }
  return down;
}

}  // namespace vibe::hardware
