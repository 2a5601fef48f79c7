#include <gtest/gtest.h>

#include <cmath>

#include "gamepad/pads.hpp"
#include "vibe_hardware/gamepad/pad_source.hpp"

namespace vibe::hardware::joy_events_test {
namespace {

/// A pad that is read through joy_node.
struct Joy {
  PadState state;
  std::vector<float> axes = std::vector<float>(8);
  std::vector<int> buttons = std::vector<int>(11);
  JoyNames names;

  void send() {
    for (const PadEvent& event : joyEvents(axes, buttons, names, state)) state.apply(event);
  }
};

TEST(JoyEvents, MoveTheScopeAsTheSamePadDoes) {
  const PadMapping mapping = shippedMapping("two_stick");
  Joy joy;
  joy.send();
  EXPECT_EQ(missingControls(mapping, joy.state), "");
  PadState pad = twoStickPad();
  DriveState by_joy = startDrive({}, mapping, joy.state), by_pad = startDrive({}, mapping, pad);
  joy.axes = {0.3F, 1.0F, 1.0F, -0.7F, 0.4F, -1.0F, -1.0F, 0};  // 1: left, forwards, a trigger at rest
  joy.buttons[0] = 1;
  joy.send();
  pad.axes[ABS_X].value = -9830, pad.axes[ABS_Y].value = -32768;
  pad.axes[ABS_RX].value = 22937, pad.axes[ABS_RY].value = -13107;
  pad.axes[ABS_Z].value = 0, pad.axes[ABS_RZ].value = 255;
  pad.axes[ABS_HAT0X].value = 1;
  pad.apply({0, EV_KEY, BTN_SOUTH, 1});
  for (int i = 0; i < 20; ++i) {
    by_joy = advance(mapping, toolLimits(), joy.state, by_joy, 0.01);
    by_pad = advance(mapping, toolLimits(), pad, by_pad, 0.01);
  }
  for (std::size_t j = 0; j < kJointCount; ++j) EXPECT_NEAR(by_joy.joints[j], by_pad.joints[j], 1e-4) << kJointNames[j];
  EXPECT_GT(by_joy.joints[HelixAdvance], 1e-3);
  EXPECT_EQ(by_joy.buttons, by_pad.buttons);
  EXPECT_EQ(by_joy.buttons[HelixGrab], 1);
}

TEST(JoyEvents, WhatHasNotMovedYetRests) {
  Joy joy;
  joy.buttons[0] = 1;  // held since before
  joy.send();
  EXPECT_EQ(joy.state.axes.at(ABS_RZ).pressure(), 0) << "0 of a trigger would be half pressed";
  EXPECT_FALSE(joy.state.buttons.at(BTN_SOUTH).isPressed());
  joy.axes[5] = 0.5F;
  joy.send();
  EXPECT_NEAR(joy.state.axes.at(ABS_RZ).pressure(), 0.25, 1e-4);
  joy.axes[5] = 0;
  joy.send();
  EXPECT_NEAR(joy.state.axes.at(ABS_RZ).pressure(), 0.5, 1e-4) << "now it is known";
}

TEST(JoyEvents, ShortLongAndBrokenMessagesDoNoHarm) {
  Joy joy;
  joy.send();
  joy.axes = {std::nanf(""), 7.0F};
  joy.buttons = std::vector<int>(500, 3);
  joy.send();
  EXPECT_EQ(joy.state.axes.at(ABS_X).deflection(), 0);
  EXPECT_EQ(joy.state.axes.at(ABS_Y).deflection(), -1);
  EXPECT_TRUE(joy.state.buttons.at(BTN_THUMBR).isPressed());
  EXPECT_EQ(joy.state.buttons.size(), 11U);
}

TEST(JoyEvents, TheMappingNamesTheNumbersOfOtherPads) {
  const PadMapping mapping = mappingOf(
      "joints:\n  insertion: {axis: ABS_THROTTLE, mode: position, range: [0 m, 0.1 m]}\n"
      "joy: {axes: [ABS_X, ABS_THROTTLE], buttons: [BTN_TRIGGER]}\n");
  Joy joy;
  joy.names = mapping.joy;
  joy.axes = {0, -0.5F, 1};
  joy.send();
  EXPECT_NEAR(joy.state.axes.at(ABS_THROTTLE).deflection(), 0.5, 1e-4);
  EXPECT_EQ(joy.state.axes.size(), 2U);
}

}  // namespace
}  // namespace vibe::hardware::joy_events_test
