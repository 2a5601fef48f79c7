#include "vibe_hardware/gamepad/pad_mapping.hpp"

#include <gtest/gtest.h>

#include "gamepad/pads.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::hardware::pad_mapping_test {
namespace {

std::string errorOf(const std::string& text) {
  try {
    parsePadMapping(text, "my_pad.yaml", toolLimits());
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

/// A joint's line in a mapping that is otherwise right; the joint is on line 3.
std::string errorOfInsertion(const std::string& content) {
  return errorOf("name: test\njoints:\n  insertion: {" + content + "}\n");
}

TEST(PadMapping, ShippedMappingsMoveEveryJointAndPressEveryButton) {
  for (const char* name : {"two_stick", "flight_stick"}) {
    const PadMapping mapping = shippedMapping(name);
    for (std::size_t i = 0; i < kJointCount; ++i)
      EXPECT_NE(mapping.joints[i].control, JointMapping::Control::None) << name << " " << kJointNames[i];
    for (std::size_t i = 0; i < kButtonCount; ++i) EXPECT_GE(mapping.buttons[i].code, 0) << name << kButtonNames[i];
  }
}

TEST(PadMapping, ShippedMappingsFitTheirPads) {
  EXPECT_EQ(missingControls(shippedMapping("two_stick"), twoStickPad()), "");
  EXPECT_EQ(missingControls(shippedMapping("flight_stick"), flightStick()), "");
  const std::string missing = missingControls(shippedMapping("two_stick"), flightStick());
  EXPECT_NE(missing.find("ABS_RX (tip_left_right)"), std::string::npos) << missing;
}

TEST(PadMapping, ReadsEveryKeyOfAJoint) {
  const PadMapping mapping = mappingOf(
      "joints:\n"
      "  insertion: {axis: ABS_Y, mode: rate, rate: 4 cm/s, dead_zone: 20 %, exponent: 3, reversed: true}\n"
      "  tip_up_down: {axis: ABS_X, mode: position, range: [-10 deg, 90 deg], full_effort: 0.3 N*m}\n"
      "buttons:\n"
      "  helix_grab: {button: BTN_SOUTH, mode: toggle}\n"
      "feedback: {rumble_force: 2 N}\n");
  const JointMapping& insertion = mapping.joints[Insertion];
  EXPECT_EQ(insertion.forward, ABS_Y);
  EXPECT_DOUBLE_EQ(insertion.rate, 0.04);
  EXPECT_DOUBLE_EQ(insertion.dead_zone, 0.2);
  EXPECT_DOUBLE_EQ(insertion.exponent, 3);
  EXPECT_TRUE(insertion.reversed);
  const JointMapping& tip = mapping.joints[TipUpDown];
  EXPECT_EQ(tip.mode, JointMapping::Mode::Position);
  EXPECT_NEAR(tip.low, -0.174533, 1e-6);
  EXPECT_NEAR(tip.high, 1.570796, 1e-6);
  EXPECT_DOUBLE_EQ(tip.full_effort, 0.3);
  EXPECT_TRUE(mapping.buttons[HelixGrab].toggle);
  EXPECT_DOUBLE_EQ(mapping.feedback.rumble_force, 2);
}

struct Mistake {
  const char* content;  // of the joint insertion
  const char* message;  // a part of it
};

TEST(PadMapping, NamesTheMistakeItsPlaceAndTheRemedy) {
  const Mistake mistakes[] = {
      {"axis: ABS_Y, mode: rate", "my_pad.yaml:3: joints.insertion: has no rate"},
      {"axis: ABS_Y, rate: 1 cm/s", "joints.insertion: has no mode; write 'mode: rate' or 'mode: position'"},
      {"mode: rate, rate: 1 cm/s", "needs exactly one of axis, axes and buttons"},
      {"axis: ABS_Y, buttons: [BTN_A, BTN_B], mode: rate, rate: 1 cm/s", "needs exactly one of axis"},
      {"axis: ABS_Q, mode: rate, rate: 1 cm/s", "'ABS_Q' is not the name of an axis"},
      {"axis: BTN_SOUTH, mode: rate, rate: 1 cm/s", "'BTN_SOUTH' is not the name of an axis"},
      {"axis: ABS_Y, mode: rat, rate: 1 cm/s", "did you mean 'rate'?"},
      {"axis: ABS_Y, mode: rate, rate: 1 m/s", "joints.insertion.rate: '1 m/s' is out of range; write a value from"},
      {"axis: ABS_Y, mode: rate, rate: 1 cm", "is a length, but it must be a speed"},
      {"axis: ABS_Y, mode: rate, rate: .nan", "is not finite"},
      {"axis: ABS_Y, mode: rate, rate: 1 cm/s, dead_zone: 1", "dead_zone: '1' is out of range"},
      {"axis: ABS_Y, mode: rate, rate: 1 cm/s, exponent: 0", "exponent: '0' is out of range"},
      {"axis: ABS_Y, mode: rate, rate: 1 cm/s, deadzone: 0", "did you mean 'dead_zone'?"},
      {"axis: ABS_Y, mode: rate, rate: 1 cm/s, reversed: 1", "'1' is neither true nor false"},
      {"axis: ABS_Y, mode: rate, rate: 1 cm/s, range: [0, 1 cm]", "goes with 'mode: position' only; remove it"},
      {"axis: ABS_Y, mode: position, range: [0, 1 cm], rate: 1 cm/s", "goes with 'mode: rate' only; remove it"},
      {"axis: ABS_Y, mode: position", "has no range"},
      {"axis: ABS_Y, mode: position, range: [0, 1 m]", "range[1]: '1 m' is out of range"},
      {"axis: ABS_Y, mode: position, range: [1 cm, 0]", "has its ends in the wrong order"},
      {"axis: ABS_Y, mode: position, range: [0, 1 cm], full_effort: -1 N", "full_effort: '-1 N' is out of range"},
      {"buttons: [BTN_A, BTN_B], mode: position, range: [0, 1 cm]", "has no axis to take a position from"},
      {"buttons: [BTN_A], mode: rate, rate: 1 cm/s", "needs two names"},
      {"buttons: [BTN_A, BTN_A], mode: rate, rate: 1 cm/s", "BTN_A is used by joints.insertion.buttons[0] already"},
  };
  for (const Mistake& mistake : mistakes) {
    const std::string said = errorOfInsertion(mistake.content);
    EXPECT_NE(said.find(mistake.message), std::string::npos) << mistake.content << "\n" << said;
    EXPECT_EQ(said.rfind("my_pad.yaml:3: joints.insertion", 0), 0u) << said;
  }
  EXPECT_EQ(errorOfInsertion("axis: ABS_Y, mode: rate, rate: 1 cm/s"), "no error");
}

TEST(PadMapping, ShowsTheLimitsOfTheUrdfWithAFewDigitsThatMayBeCopied) {
  const std::string start = "my_pad.yaml:3: joints.";
  EXPECT_EQ(errorOfInsertion("axis: ABS_Y, mode: rate, rate: 1 m/s"),
            start + "insertion.rate: '1 m/s' is out of range; write a value from 0 m/s to 0.15 m/s");
  const std::string joint = "name: test\njoints:\n  rotation: {axis: ABS_Y, mode: position, range: ";
  EXPECT_EQ(errorOf(joint + "[-200 deg, 0]}\n"),
            start + "rotation.range[0]: '-200 deg' is out of range; write a value from -3.141593 rad to 3.141593 rad");
  EXPECT_EQ(errorOf(joint + "[-3.141593, 3.141593]}\n"), "no error");
  EXPECT_EQ(errorOf(joint + "[0, 1, 2]}\n"), start + "rotation.range: needs two values; write [lowest, highest]");
}

TEST(PadMapping, NamesMistakesOutsideOfJoints) {
  EXPECT_EQ(errorOf("name: a\njoint: {}\n"), "my_pad.yaml:2: joint: is not a known key; did you mean 'joints'?");
  EXPECT_EQ(errorOf("name: a\n"), "my_pad.yaml:1: moves nothing; write at least one joint below 'joints:'");
  EXPECT_NE(errorOf("joints: {}\n").find("has no name"), std::string::npos);
  EXPECT_EQ(errorOf("name: a\njoints: {insertoin: {}}\n"),
            "my_pad.yaml:2: joints.insertoin: is not a joint; did you mean 'insertion'?");
  EXPECT_EQ(errorOf("name: a\nbuttons: {helix_grip: {button: BTN_A}}\n"),
            "my_pad.yaml:2: buttons.helix_grip: is not a button; did you mean 'helix_grab'?");
  EXPECT_NE(errorOf("name: a\nbuttons: {needle: {button: BTN_SUOTH}}\n").find("did you mean 'BTN_SOUTH'?"),
            std::string::npos);
  EXPECT_NE(errorOf("name: a\nbuttons: {needle: {button: BTN_A, mode: press}}\n").find("'press' is not known here"),
            std::string::npos);
  EXPECT_NE(errorOf("name: a\nbuttons: {needle: {button: BTN_A}, cinch: {button: BTN_SOUTH}}\n")
                .find("BTN_SOUTH is used by buttons.needle.button already"),
            std::string::npos);
}

}  // namespace
}  // namespace vibe::hardware::pad_mapping_test
