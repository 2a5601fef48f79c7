#include "vibe_hardware/gamepad/pad_drive.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "gamepad/pads.hpp"

namespace vibe::hardware::pad_drive_test {
namespace {

constexpr double kPeriod = 0.01;

using Joints = std::array<double, kJointCount>;

DriveState begin(const Joints& joints) {
  return startDrive(joints, {}, {});
}

/// The joints in the middle of their ranges.
Joints middle() {
  Joints joints{};
  for (std::size_t i = 0; i < kJointCount; ++i) joints[i] = 0.5 * (toolLimits()[i].lower + toolLimits()[i].upper);
  return joints;
}

DriveState drive(const PadMapping& mapping, const PadState& pad, DriveState state, int periods) {
  for (int k = 0; k < periods; ++k) state = advance(mapping, toolLimits(), pad, state, kPeriod);
  return state;
}

const char* const kRate = "joints: {insertion: {axis: ABS_Y, mode: rate, rate: 4 cm/s, dead_zone: 0.1, exponent: 2}}";
const char* const kPosition = "joints: {insertion: {axis: ABS_THROTTLE, mode: position, range: [0 cm, 20 cm]}}";

TEST(PadDrive, DeflectionIsZeroInTheDeadZoneMonotoneOddAndFull) {
  const JointMapping joint = mappingOf(kRate).joints[Insertion];
  PadState pad = twoStickPad();
  double last = -2;
  for (int value = -32768; value <= 32767; ++value) {
    pad.axes[ABS_Y].value = value;
    const double deflection = controlDeflection(joint, pad);
    ASSERT_GE(deflection, last) << value;
    ASSERT_EQ(deflection == 0, std::abs(pad.axes[ABS_Y].deflection()) <= 0.1) << value;
    last = deflection;
    pad.axes[ABS_Y].value = -1 - value;  // the mirrored value of this range
    ASSERT_NEAR(controlDeflection(joint, pad), -deflection, 1e-12);
  }
  EXPECT_DOUBLE_EQ(last, 1);
  deflect(pad, ABS_Y, 0.55);
  EXPECT_NEAR(controlDeflection(joint, pad), 0.25, 1e-4);  // ((0.55 - 0.1) / 0.9)^2
}

TEST(PadDrive, ReversedControlsDeflectTheOtherWay) {
  JointMapping joint = mappingOf(kRate).joints[Insertion];
  PadState pad = twoStickPad();
  deflect(pad, ABS_Y, 0.7);
  const double deflection = controlDeflection(joint, pad);
  joint.reversed = true;
  EXPECT_EQ(controlDeflection(joint, pad), -deflection);
}

TEST(PadDrive, TriggersAtRestMoveNothing) {
  const PadMapping mapping = shippedMapping("two_stick");
  const DriveState before = begin(middle());
  EXPECT_EQ(drive(mapping, twoStickPad(), before, 500).joints, before.joints);
}

TEST(PadDrive, TriggersAndButtonPairsMoveBothWays) {
  const PadMapping mapping = shippedMapping("two_stick");
  const Joints start = middle();
  PadState pad = twoStickPad();
  pad.axes[ABS_RZ].value = 255;
  press(pad, BTN_TL);
  DriveState state = drive(mapping, pad, begin(start), 10);
  EXPECT_NEAR(state.joints[HelixAdvance] - start[HelixAdvance], 0.02 * 0.1, 1e-12);
  EXPECT_NEAR(state.joints[NeedleDriver] - start[NeedleDriver], -0.03 * 0.1, 1e-12);
  pad.axes[ABS_RZ].value = 0;
  pad.axes[ABS_Z].value = 255;
  letGo(pad, BTN_TL);
  press(pad, BTN_TR);
  state = drive(mapping, pad, state, 10);
  EXPECT_NEAR(state.joints[HelixAdvance], start[HelixAdvance], 1e-12);
  EXPECT_NEAR(state.joints[NeedleDriver], start[NeedleDriver], 1e-12);
}

TEST(PadDrive, RateIntegratesExactly) {
  const PadMapping mapping = mappingOf(kRate);
  PadState pad = twoStickPad();
  for (const double deflection : {-1.0, -0.4, 0.05, 0.3, 1.0}) {
    deflect(pad, ABS_Y, deflection);
    const double speed = 0.04 * controlDeflection(mapping.joints[Insertion], pad);
    const Joints start = middle();
    for (const double period : {0.002, 0.01, 0.04}) {
      DriveState state = begin(start);
      const int steps = static_cast<int>(1 / period);
      for (int k = 0; k < steps; ++k) state = advance(mapping, toolLimits(), pad, state, period);
      EXPECT_NEAR(state.joints[Insertion], start[Insertion] + speed * steps * period, 1e-13);
    }
  }
}

TEST(PadDrive, LimitsAndSpeedsHoldForAnyMotionOfThePad) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> deflection(-1, 1), period(0, 0.3);
  for (const auto& [name, pad_at_rest] :
       {std::make_pair("two_stick", twoStickPad()), std::make_pair("flight_stick", flightStick())}) {
    const PadMapping mapping = shippedMapping(name);
    PadState pad = pad_at_rest;
    DriveState state = begin({});
    for (int k = 0; k < 20000; ++k) {
      for (auto& [code, axis] : pad.axes)
        if (random() % 50 == 0) deflect(pad, code, deflection(random));
      for (auto& [code, button] : pad.buttons)
        if (random() % 50 == 0) pad.apply({0, EV_KEY, code, button.down ? 0 : 1});
      const double dt = period(random);
      const DriveState next = advance(mapping, toolLimits(), pad, state, dt);
      for (std::size_t i = 0; i < kJointCount; ++i) {
        const JointLimits& limits = toolLimits()[i];
        ASSERT_GE(next.joints[i], limits.lower) << kJointNames[i];
        ASSERT_LE(next.joints[i], limits.upper) << kJointNames[i];
        const double most = limits.velocity * std::min(dt, 0.1) * (1 + 1e-12) + 1e-15;
        ASSERT_LE(std::abs(next.joints[i] - state.joints[i]), most) << name << " " << kJointNames[i];
      }
      state = next;
    }
  }
}

TEST(PadDrive, JointsReachTheirLimits) {
  const PadMapping mapping = mappingOf(kRate);
  PadState pad = twoStickPad();
  deflect(pad, ABS_Y, 1);
  EXPECT_EQ(drive(mapping, pad, begin({}), 2000).joints[Insertion], toolLimits()[Insertion].upper);
  deflect(pad, ABS_Y, -1);
  EXPECT_EQ(drive(mapping, pad, begin({}), 2000).joints[Insertion], toolLimits()[Insertion].lower);
}

TEST(PadDrive, PositionControlElsewhereThanItsJointMovesNothing) {
  const PadMapping mapping = mappingOf(kPosition);
  PadState pad = flightStick();
  deflect(pad, ABS_THROTTLE, 0.5);  // 15 cm
  const DriveState state = drive(mapping, pad, begin({0.03}), 300);
  EXPECT_EQ(state.joints[Insertion], 0.03);
  EXPECT_FALSE(state.engaged[Insertion]);
  EXPECT_NE(waitingControls(mapping, state).find("ABS_THROTTLE (now at 75 % of its way, insertion is at 15 %)"),
            std::string::npos)
      << waitingControls(mapping, state);
}

TEST(PadDrive, PositionControlPicksItsJointUpWhenItComesNear) {
  const PadMapping mapping = mappingOf(kPosition);
  PadState pad = flightStick();
  deflect(pad, ABS_THROTTLE, 0.5);
  DriveState state = drive(mapping, pad, begin({0.03}), 3);
  deflect(pad, ABS_THROTTLE, -0.68);  // 3.2 cm: within 2 % of the range
  state = drive(mapping, pad, state, 100);
  EXPECT_TRUE(state.engaged[Insertion]);
  EXPECT_NEAR(state.joints[Insertion], 0.032, 2e-4);
  EXPECT_EQ(waitingControls(mapping, state), "");
  deflect(pad, ABS_THROTTLE, 0.5);
  state = drive(mapping, pad, state, 200);
  EXPECT_NEAR(state.joints[Insertion], 0.15, 2e-4);
}

TEST(PadDrive, PositionControlPicksItsJointUpWhenItPassesQuickly) {
  const PadMapping mapping = mappingOf(kPosition);
  PadState pad = flightStick();
  deflect(pad, ABS_THROTTLE, 0.5);
  DriveState state = drive(mapping, pad, begin({0.03}), 1);
  deflect(pad, ABS_THROTTLE, -1);  // past 3 cm within one period
  state = drive(mapping, pad, state, 1);
  EXPECT_TRUE(state.engaged[Insertion]);
  EXPECT_NEAR(state.joints[Insertion], 0.03 - toolLimits()[Insertion].velocity * kPeriod, 1e-12);
}

TEST(PadDrive, JointOutsideTheRangeOfItsControlIsPickedUpAtTheNearestEnd) {
  const PadMapping mapping = mappingOf(kPosition);
  PadState pad = flightStick();
  deflect(pad, ABS_THROTTLE, 0.9);
  DriveState state = drive(mapping, pad, begin({0.28}), 10);
  EXPECT_FALSE(state.engaged[Insertion]);
  deflect(pad, ABS_THROTTLE, 1);
  state = drive(mapping, pad, state, 1);
  EXPECT_TRUE(state.engaged[Insertion]);
  EXPECT_NEAR(state.joints[Insertion], 0.28, toolLimits()[Insertion].velocity * kPeriod + 1e-12);
}

TEST(PadDrive, HeldButtonsHoldAndTogglesSwitch) {
  const PadMapping mapping =
      mappingOf("buttons: {needle: {button: BTN_EAST, mode: hold}, helix_grab: {button: BTN_SOUTH, mode: toggle}}");
  PadState pad = twoStickPad();
  press(pad, BTN_EAST);
  press(pad, BTN_SOUTH);
  DriveState state = drive(mapping, pad, begin({}), 5);
  EXPECT_EQ(state.buttons[Needle], 1);
  EXPECT_EQ(state.buttons[HelixGrab], 1);
  letGo(pad, BTN_EAST);
  letGo(pad, BTN_SOUTH);
  state = drive(mapping, pad, state, 5);
  EXPECT_EQ(state.buttons[Needle], 0);
  EXPECT_EQ(state.buttons[HelixGrab], 1);
  press(pad, BTN_SOUTH);
  EXPECT_EQ(drive(mapping, pad, state, 5).buttons[HelixGrab], 0);
}

TEST(PadDrive, TapBetweenTwoPeriodsIsNotLost) {
  const PadMapping mapping =
      mappingOf("buttons: {needle: {button: BTN_EAST, mode: hold}, helix_grab: {button: BTN_SOUTH, mode: toggle}}");
  PadState pad = twoStickPad();
  for (const int code : {BTN_EAST, BTN_SOUTH}) {
    press(pad, code);
    letGo(pad, code);
  }
  DriveState state = drive(mapping, pad, begin({}), 1);
  EXPECT_EQ(state.buttons[Needle], 1);
  EXPECT_EQ(state.buttons[HelixGrab], 1);
  state = drive(mapping, pad, state, 1);
  EXPECT_EQ(state.buttons[Needle], 0);
  EXPECT_EQ(state.buttons[HelixGrab], 1);
}

TEST(PadDrive, ButtonThatIsDownWhenThePadIsFoundIsNotPressed) {
  const PadMapping mapping = mappingOf("buttons: {apc_pedal: {button: BTN_NORTH, mode: hold}}");
  PadState pad = twoStickPad();
  pad.buttons[BTN_NORTH].down = true;
  EXPECT_EQ(drive(mapping, pad, begin({}), 5).buttons[ApcPedal], 0);
  letGo(pad, BTN_NORTH);
  press(pad, BTN_NORTH);
  EXPECT_EQ(drive(mapping, pad, begin({}), 5).buttons[ApcPedal], 1);
}

TEST(PadDrive, PressesBeforeTheBeginningDoNotCount) {
  const PadMapping mapping = mappingOf("buttons: {insufflate: {button: BTN_START, mode: toggle}}");
  PadState pad = twoStickPad();
  press(pad, BTN_START);
  letGo(pad, BTN_START);
  DriveState state = drive(mapping, pad, startDrive({}, mapping, pad), 5);
  EXPECT_EQ(state.buttons[Insufflate], 0);
  press(pad, BTN_START);
  EXPECT_EQ(drive(mapping, pad, state, 5).buttons[Insufflate], 1);
}

TEST(PadDrive, UnplugReleasesButtonsAndHoldsJoints) {
  const PadMapping mapping = shippedMapping("flight_stick");
  PadState pad = flightStick();
  press(pad, BTN_TRIGGER);
  press(pad, BTN_THUMB);
  const DriveState driven = drive(mapping, pad, begin({}), 50);
  ASSERT_EQ(driven.buttons[HelixGrab], 1);
  ASSERT_TRUE(driven.engaged[TipUpDown]);
  const DriveState released = releaseDrive(driven);
  EXPECT_EQ(released.joints, driven.joints);
  EXPECT_EQ(released.buttons, decltype(released.buttons){});
  EXPECT_EQ(released.engaged, decltype(released.engaged){});
  // the same pad again: what was switched on stays off until it is pressed again
  EXPECT_EQ(drive(mapping, flightStick(), released, 5).buttons, decltype(released.buttons){});
}

TEST(PadDrive, CommandStaysNearASimulatorThatStandsStill) {
  const PadMapping mapping = mappingOf(kRate);
  PadState pad = twoStickPad();
  deflect(pad, ABS_Y, 1);
  const Joints measured{0.05};
  DriveState state = begin(measured);
  for (int k = 0; k < 1000; ++k)
    state = followJoints(measured, toolLimits(), advance(mapping, toolLimits(), pad, state, kPeriod));
  const double lead = 0.25 * toolLimits()[Insertion].velocity;
  EXPECT_NEAR(state.joints[Insertion], 0.05 + lead, 1e-12);
  EXPECT_GT(lead, 0.04 * 0.1);  // a simulator that answers within 0.1 s never limits the pad
}

TEST(PadDrive, JointThatTheSimulatorHasPutElsewhereIsTakenOver) {
  const PadMapping mapping = mappingOf(kPosition);
  PadState pad = flightStick();
  DriveState state = drive(mapping, pad, begin({0.1}), 3);
  ASSERT_TRUE(state.engaged[Insertion]);
  state = followJoints({0}, toolLimits(), state);  // reset
  EXPECT_EQ(state.joints[Insertion], 0);
  EXPECT_EQ(drive(mapping, pad, state, 100).joints[Insertion], 0);  // until the throttle comes to zero
}

TEST(PadDrive, NoTapOfAButtonThatMovesAJointIsLost) {
  const PadMapping mapping =
      mappingOf("joints:\n  needle_driver: {buttons: [BTN_TR, BTN_TL], mode: rate, rate: 3 cm/s}");
  PadState pad = twoStickPad();
  press(pad, BTN_TR), letGo(pad, BTN_TR);
  DriveState state = drive(mapping, pad, startDrive(middle(), mapping, pad), 1);
  EXPECT_EQ(state.joints, middle()) << "what was before does not count";
  press(pad, BTN_TR), letGo(pad, BTN_TR);
  state = drive(mapping, pad, state, 5);
  EXPECT_NEAR(state.joints[NeedleDriver] - middle()[NeedleDriver], 0.03 * kPeriod, 1e-12) << "one period";
  press(pad, BTN_TL), letGo(pad, BTN_TL);
  EXPECT_NEAR(drive(mapping, pad, state, 5).joints[NeedleDriver], middle()[NeedleDriver], 1e-12);
}

TEST(PadDrive, AJointThatRestsGoesWithWhoElseMovesItAndDoesNotPull) {
  const PadMapping mapping = mappingOf(kRate);
  const double lead = 0.25 * toolLimits()[Insertion].velocity;
  DriveState state = drive(mapping, twoStickPad(), begin({0.05}), 1);
  state = followJoints({0.05 + 0.9 * lead}, toolLimits(), state);
  EXPECT_EQ(state.joints[Insertion], 0.05) << "the tissue may hold the tool back";
  state = followJoints({0.05 + 1.1 * lead}, toolLimits(), state);
  EXPECT_EQ(state.joints[Insertion], 0.05 + 1.1 * lead);
  state = releaseDrive(state);
  EXPECT_EQ(followJoints({0.05}, toolLimits(), state).joints[Insertion], 0.05) << "also without a pad";
}

TEST(PadDrive, AxesThatThePadLacksMoveNothing) {
  const DriveState start = begin(middle());
  EXPECT_EQ(drive(shippedMapping("two_stick"), PadState{}, start, 10).joints, start.joints);
  EXPECT_EQ(drive(shippedMapping("flight_stick"), PadState{}, start, 10).joints, start.joints);
}

}  // namespace
}  // namespace vibe::hardware::pad_drive_test
