#include "vibe_hardware/gamepad/pad_drive.hpp"

#include <linux/input-event-codes.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "vibe_core/files/number_text.hpp"

namespace vibe::hardware {
namespace {

constexpr double kLongestStep = 0.1;  // [s]
constexpr double kPickUp = 0.02;      // of the range: near enough to pick a joint up without a visible jump
constexpr double kLead = 0.25;        // the simulator answers within two steps; more means that it stands still [s]

double axisOf(const PadState& pad, int code) {
  const auto axis = pad.axes.find(code);
  return axis == pad.axes.end() ? 0 : axis->second.deflection();
}

/// From 0 at rest to 1; an axis that is missing rests.
double triggerOf(const PadState& pad, int code) {
  const auto axis = pad.axes.find(code);
  return axis == pad.axes.end() ? 0 : axis->second.pressure();
}

double buttonOf(const PadState& pad, int code) {
  const auto button = pad.buttons.find(code);
  return button != pad.buttons.end() && button->second.isPressed() ? 1 : 0;
}

std::uint32_t pressesOf(const PadState& pad, int code) {
  const auto button = pad.buttons.find(code);
  return button == pad.buttons.end() ? 0 : button->second.presses;
}

/// 1 if a button was pressed since the last call and is up again. @param used  presses so far; brought up to date
double tapOf(const PadState& pad, int code, std::uint32_t& used) {
  const std::uint32_t before = std::exchange(used, pressesOf(pad, code));
  return used != before ? 1 - buttonOf(pad, code) : 0;
}

double shaped(double deflection, double dead_zone, double exponent) {
  const double beyond = (std::abs(deflection) - dead_zone) / (1 - dead_zone);
  return beyond <= 0 ? 0 : std::copysign(std::pow(beyond, exponent), deflection);
}

double positionTarget(const JointMapping& joint, const PadState& pad) {
  return joint.low + (joint.high - joint.low) * 0.5 * (controlDeflection(joint, pad) + 1);
}

/// Whether the control has come to where the joint is. A joint outside the range is picked up at the nearest end.
bool picksUp(const JointMapping& joint, double position, double target, double last_target) {
  const double wanted = std::clamp(position, joint.low, joint.high);
  if (std::abs(target - wanted) <= kPickUp * (joint.high - joint.low)) return true;
  return std::isfinite(last_target) && (target - wanted) * (last_target - wanted) < 0;
}

void moveJoint(const JointMapping& mapping, const JointLimits& limits, const PadState& pad, double dt, int index,
               DriveState& state) {
  const auto i = static_cast<std::size_t>(index);
  if (mapping.control == JointMapping::Control::None) return;
  double& joint = state.joints[i];
  double deflection = controlDeflection(mapping, pad);
  if (mapping.control == JointMapping::Control::Buttons) {
    const double tap = tapOf(pad, mapping.forward, state.taps[i][0]) - tapOf(pad, mapping.backward, state.taps[i][1]);
    deflection = std::clamp(deflection + (mapping.reversed ? -tap : tap), -1.0, 1.0);
  }
  double motion = deflection * mapping.rate * dt;
  if (mapping.mode == JointMapping::Mode::Position) {
    const auto axis = pad.axes.find(mapping.forward);
    if (axis == pad.axes.end() || !axis->second.is_known) return;
    const double target = positionTarget(mapping, pad);
    state.engaged[i] = state.engaged[i] || picksUp(mapping, joint, target, state.targets[i]);
    state.targets[i] = target;
    motion = state.engaged[i] ? target - joint : 0;
  }
  state.resting[i] = motion == 0;
  const double most = limits.velocity * dt;
  joint = std::clamp(joint + std::clamp(motion, -most, most), limits.lower, limits.upper);
}

void pressButton(const ButtonMapping& mapping, const PadState& pad, int index, DriveState& state) {
  const auto i = static_cast<std::size_t>(index);
  const auto button = pad.buttons.find(mapping.code);
  if (button == pad.buttons.end()) return;
  const std::uint32_t fresh = button->second.presses - state.presses[i];
  state.presses[i] = button->second.presses;
  if (mapping.toggle) {
    state.buttons[i] = (state.buttons[i] + fresh) % 2 == 1;
  } else {
    state.buttons[i] = button->second.isPressed() || fresh > 0;  // a short tap lasts one period
  }
}

}  // namespace

double controlDeflection(const JointMapping& joint, const PadState& pad) {
  double deflection = 0;
  switch (joint.control) {
    case JointMapping::Control::None:
      return 0;
    case JointMapping::Control::Axis:
      deflection = axisOf(pad, joint.forward);
      break;
    case JointMapping::Control::Axes:
      deflection = triggerOf(pad, joint.forward) - triggerOf(pad, joint.backward);
      break;
    case JointMapping::Control::Buttons:
      deflection = buttonOf(pad, joint.forward) - buttonOf(pad, joint.backward);
      break;
  }
  const double result = shaped(deflection, joint.dead_zone, joint.exponent);
  return joint.reversed ? -result : result;
}

DriveState startDrive(const std::array<double, kJointCount>& joints, const PadMapping& mapping, const PadState& pad) {
  DriveState state;
  state.joints = joints;
  state.targets.fill(std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < kButtonCount; ++i) state.presses[i] = pressesOf(pad, mapping.buttons[i].code);
  for (std::size_t i = 0; i < kJointCount; ++i)
    state.taps[i] = {pressesOf(pad, mapping.joints[i].forward), pressesOf(pad, mapping.joints[i].backward)};
  return state;
}

DriveState advance(const PadMapping& mapping, const ToolLimits& limits, const PadState& pad, DriveState state,
                   double dt) {
  dt = std::clamp(dt, 0.0, kLongestStep);
  for (int i = 0; i < kJointCount; ++i) {
    const auto joint = static_cast<std::size_t>(i);
    moveJoint(mapping.joints[joint], limits[joint], pad, dt, i, state);
  }
  for (int i = 0; i < kButtonCount; ++i) pressButton(mapping.buttons[static_cast<std::size_t>(i)], pad, i, state);
  return state;
}

DriveState releaseDrive(DriveState state) {
  state = startDrive(state.joints, {}, {});
  state.resting.fill(true);
  return state;
}

DriveState followJoints(const std::array<double, kJointCount>& measured, const ToolLimits& limits, DriveState state) {
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const double lead = kLead * limits[i].velocity;
    const double ahead = state.joints[i] - measured[i];
    if (std::abs(ahead) > (state.resting[i] ? 1 : 2) * lead) {
      state.joints[i] = measured[i];
      state.engaged[i] = false;
      state.targets[i] = std::numeric_limits<double>::quiet_NaN();
    } else if (std::abs(ahead) > lead) {
      state.joints[i] = measured[i] + std::copysign(lead, ahead);
    }
  }
  return state;
}

std::string waitingControls(const PadMapping& mapping, const DriveState& state) {
  std::string list;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const JointMapping& joint = mapping.joints[i];
    if (joint.mode != JointMapping::Mode::Position || state.engaged[i] || !std::isfinite(state.targets[i])) continue;
    const double range = joint.high - joint.low;
    const double wanted = (std::clamp(state.joints[i], joint.low, joint.high) - joint.low) / range;
    list += formatted("%s%s (now at %.0f %% of its way, %s is at %.0f %%)", list.empty() ? "" : ", ",
                      eventCodeName(EV_ABS, joint.forward).c_str(), 100 * (state.targets[i] - joint.low) / range,
                      kJointNames[i], 100 * wanted);
  }
  return list.empty() ? "" : "Move each of these to where its joint is, to pick the joint up: " + list + ".";
}

std::string missingControls(const PadMapping& mapping, const PadState& pad) {
  std::string list;
  const auto note = [&](int type, int code, const char* user) {
    const bool has = type == EV_ABS ? pad.axes.count(code) > 0 : pad.buttons.count(code) > 0;
    if (code < 0 || has) return;
    list += (list.empty() ? "" : ", ") + eventCodeName(type, code) + " (" + user + ")";
  };
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const bool buttons = mapping.joints[i].control == JointMapping::Control::Buttons;
    note(buttons ? EV_KEY : EV_ABS, mapping.joints[i].forward, kJointNames[i]);
    note(buttons ? EV_KEY : EV_ABS, mapping.joints[i].backward, kJointNames[i]);
  }
  for (std::size_t i = 0; i < kButtonCount; ++i) note(EV_KEY, mapping.buttons[i].code, kButtonNames[i]);
  return list.empty() ? "" : "This pad has no " + list + "; choose another mapping or change it.";
}

}  // namespace vibe::hardware
