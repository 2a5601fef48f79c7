#include "vibe_hardware/driver/calibration.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <ostream>
#include <string>

#include "vibe_core/program/error.hpp"

namespace vibe::hardware::calibration_test {
namespace {

std::string shipped() {
  std::ifstream file("../config/devices.yaml");
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The shipped calibration with a part replaced.
std::string with(const std::string& part, const std::string& other) {
  std::string text = shipped();
  const std::size_t at = text.find(part);
  EXPECT_NE(at, std::string::npos) << part;
  return at == std::string::npos ? text : text.replace(at, part.size(), other);
}

std::string errorOf(const std::string& text) {
  try {
    Calibration::parse(text, "devices.yaml");
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

struct Mistake {
  const char* part;
  const char* other;
  const char* sentence;  // part of it, after file and line
};

void PrintTo(const Mistake& mistake, std::ostream* stream) {
  *stream << mistake.other;
}

class CalibrationMistakes : public testing::TestWithParam<Mistake> {};

TEST(Calibration, TheShippedOneIsRead) {
  const Calibration c = Calibration::load("../config/devices.yaml");
  EXPECT_EQ(c.devices[0].vendor, 0x1209);
  EXPECT_EQ(c.devices[1].product, 2);
  EXPECT_DOUBLE_EQ(c.joints[Insertion].scale.scale, 0.01);
  EXPECT_DOUBLE_EQ(c.joints[Insertion].upper, 0.3);
  EXPECT_EQ(c.joints[TipLeftRight].device, DeviceKind::Input);
  EXPECT_EQ(c.joints[TipLeftRight].axis, 1);
  EXPECT_EQ(c.jointOf(DeviceKind::Haptic, 1), Rotation);
  EXPECT_EQ(c.joints[Rotation].home, 0.0);
  EXPECT_EQ(c.buttons[Insufflate]->bit, 5);
  EXPECT_EQ(c.homing->bit, 6);
  ASSERT_TRUE(c.suturing_device);
  EXPECT_NEAR((*c.suturing_device)[1].speed, 12.566, 1e-3);
  EXPECT_DOUBLE_EQ((*c.suturing_device)[2].upper, 0.018);
}

TEST(Calibration, DirectionSerialAndMissingSections) {
  const Calibration c =
      Calibration::parse(with("scale: 1, limits: [-180", "scale: 2, direction: -1, limits: [-180"), "");
  EXPECT_DOUBLE_EQ(c.joints[Rotation].scale.scale, -2);
  EXPECT_EQ(Calibration::parse(with("{id: 1209:0002}", "{id: 1209:0002, serial: \"007\"}"), "").devices[1].serial,
            "007");
  const std::string text = shipped();
  const Calibration small = Calibration::parse(text.substr(0, text.find("homing:")), "");
  EXPECT_FALSE(small.homing || small.suturing_device || small.buttons[0]);
  EXPECT_FALSE(small.joints[0].home);
}

TEST_P(CalibrationMistakes, HasItsSentence) {
  const Mistake& mistake = GetParam();
  const std::string text = with(mistake.part, mistake.other);
  const std::string error = errorOf(text);
  EXPECT_NE(error.find(mistake.sentence), std::string::npos) << error;
  EXPECT_EQ(error.rfind("devices.yaml:", 0), 0U) << error;
}

INSTANTIATE_TEST_SUITE_P(
    All, CalibrationMistakes,
    testing::Values(
        Mistake{"\ndevices:", "\ndevises:", "devises: is not a known key; did you mean 'devices'?"},
        Mistake{"  input: {id: 1209:0002}\n", "", "devices: lacks the key 'input'; add it below"},
        Mistake{"1209:0001", "1209", "devices.haptic.id: '1209' is not a USB id; write vendor and product as lsusb"},
        Mistake{"1209:0001", "1209:00g1", "is not a USB id"},
        Mistake{"axis: 0, scale: 10 mm/rad", "axes: 0, scale: 10 mm/rad",
                "joints.insertion.axes: is not a known key; did you mean 'axis'?"},
        Mistake{"axis: 0, scale: 10", "axis: 2, scale: 10",
                "joints.insertion.axis: '2' is out of range; write a whole number from 0 to 1"},
        Mistake{"axis: 0, scale: 10", "axis: first, scale: 10", "is not a whole number"},
        Mistake{"10 mm/rad", "10 mm", "joints.insertion.scale: '10 mm' is a length, but it must be a value in m/rad"},
        Mistake{"10 mm/rad", ".nan", "is not finite"},
        Mistake{"10 mm/rad", "0", "joints.insertion.scale: '0' is out of range"},
        Mistake{"10 mm/rad", "-0.01", "is out of range"},
        Mistake{"10 mm/rad", "[1, 2]", "joints.insertion.scale: is a list"},
        Mistake{"scale: 10 mm/rad,", "", "joints.insertion: lacks the key 'scale'"},
        Mistake{"[0 m, 0.3 m]", "[0.3 m, 0 m]", "joints.insertion.limits: does not have its lower end first"},
        Mistake{"[0 m, 0.3 m]", "[0 m]", "joints.insertion.limits: has 1 values; write 2"},
        Mistake{"[0 m, 0.3 m]", "[0 m, 30 m]", "is out of range"},
        Mistake{"[0 m, 0.3 m]", "[0 m, .inf]", "is not finite"},
        Mistake{"device: haptic, axis: 0", "device: hepatic, axis: 0",
                "'hepatic' is not known here; did you mean 'haptic'?"},
        Mistake{"device: input, axis: 1", "device: input, axis: 0",
                "joints: tip_up_down and tip_left_right are both measured by axis 0 of the input device"},
        Mistake{"scale: 1, limits: [-180", "scale: 1, direction: 2, limits: [-180",
                "joints.rotation.direction: '2' is not known here"},
        Mistake{"scale: 1, limits: [-180", "scale: 1, offset: 1 m, limits: [-180",
                "joints.rotation.offset: '1 m' is a length, but it must be an angle"},
        Mistake{"insertion: 0 m, rotation", "insertion: 5 cm, insertion: 0, rotation",
                "homing.positions.insertion: is given a second time"},
        Mistake{"{insertion: 0 m", "{insertion: 0.4 m",
                "homing.positions.insertion: is outside the limits of the joint, 0 m to 0.3 m"},
        Mistake{"{insertion: 0 m", "{insertoin: 0 m",
                "homing.positions.insertoin: is not a known key; did you mean 'insertion'?"},
        Mistake{"bit: 6}", "bit: 16}", "homing.button.bit: '16' is out of range; write a whole number from 0 to 15"},
        Mistake{"  apc_pedal:", "  apc_petal:", "buttons.apc_petal: is not a known key; did you mean 'apc_pedal'?"},
        Mistake{"speed: 10 mm/s", "speed: 10 mm",
                "suturing_device.helix_advance.speed: '10 mm' is a length, but it must be a speed"},
        Mistake{"    speed: 10 mm/s\n", "", "suturing_device.helix_advance: lacks the key 'speed'"},
        Mistake{"limits: [0 mm, 30 mm]", "limits: [5 mm, 30 mm]",
                "suturing_device.helix_advance: has limits without 0"}));

TEST(Calibration, FileAndLineAreThoseOfTheMistake) {
  EXPECT_EQ(errorOf("devices:\n  haptic: {id: 1209:0001}\n  inptu: {id: 1209:0002}\njoints: {}\n"),
            "devices.yaml:3: devices.inptu: is not a known key; did you mean 'input'?");
  EXPECT_NE(errorOf("[]").find("devices.yaml:1: is a list at the top"), std::string::npos);
  EXPECT_NE(errorOf("joints: {").find("devices.yaml:"), std::string::npos);
  EXPECT_THROW(Calibration::load("/no/such/file.yaml"), Error);
}

}  // namespace
}  // namespace vibe::hardware::calibration_test
