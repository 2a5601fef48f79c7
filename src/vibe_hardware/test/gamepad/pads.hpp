#pragma once
#include <linux/input-event-codes.h>

#include <cmath>
#include <string>

#include "vibe_hardware/gamepad/pad_drive.hpp"
#include "vibe_hardware/gamepad/pad_mapping.hpp"
#include "vibe_hardware/gamepad/pad_state.hpp"

// Pads and mappings for tests.

namespace vibe::hardware {

inline const ToolLimits& toolLimits() {
  static const ToolLimits limits = loadToolLimits("../../vibe_description/urdf/scope.urdf");
  return limits;
}

inline PadMapping mappingOf(const std::string& text) {
  return parsePadMapping("name: test\n" + text, "test.yaml", toolLimits());
}

inline PadMapping shippedMapping(const std::string& name) {
  return loadPadMapping("../config/gamepads/" + name + ".yaml", toolLimits());
}

/// A pad with two sticks from -32768 to 32767, two triggers from 0 to 255 at rest, a cross and the usual buttons.
inline PadState twoStickPad() {
  PadState pad;
  for (const int code : {ABS_X, ABS_Y, ABS_RX, ABS_RY}) pad.axes[code] = {-32768, 32767, 0};
  for (const int code : {ABS_Z, ABS_RZ}) pad.axes[code] = {0, 255, 0};
  for (const int code : {ABS_HAT0X, ABS_HAT0Y}) pad.axes[code] = {-1, 1, 0};
  for (const int code : {BTN_SOUTH, BTN_EAST, BTN_NORTH, BTN_WEST, BTN_TL, BTN_TR, BTN_SELECT, BTN_START})
    pad.buttons[code];
  return pad;
}

/// A flight stick with throttle, twist and hat; axes from 0 to 1023 in the middle.
inline PadState flightStick() {
  PadState pad;
  for (const int code : {ABS_X, ABS_Y, ABS_RZ, ABS_THROTTLE}) pad.axes[code] = {0, 1023, 512};
  for (const int code : {ABS_HAT0X, ABS_HAT0Y}) pad.axes[code] = {-1, 1, 0};
  for (int code = BTN_TRIGGER; code <= BTN_BASE2; ++code) pad.buttons[code];
  return pad;
}

/// Puts an axis to a deflection from -1 to 1.
inline void deflect(PadState& pad, int code, double deflection) {
  PadAxis& axis = pad.axes.at(code);
  axis.value = static_cast<int>(std::lround(axis.minimum + 0.5 * (deflection + 1) * (axis.maximum - axis.minimum)));
}

inline void press(PadState& pad, int code) {
  pad.apply({0, EV_KEY, code, 1});
}
inline void letGo(PadState& pad, int code) {
  pad.apply({0, EV_KEY, code, 0});
}

}  // namespace vibe::hardware
