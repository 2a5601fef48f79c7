#include "vibe_vision/config/vision_config.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <ostream>
#include <string>

#include "vibe_testing/expect_error.hpp"
#include "vibe_vision/synthetic/synthetic_scene.hpp"

namespace vibe::vision::vision_config_test {
namespace {

const char* const kText = R"(camera:
  size: [728, 544]
  focal_length: [2500 px, 2500 px]
  centre: [363.5 px, 271.5 px]
instruments:
  - name: helix
    marker:
      sleeve: {}
    axis: {origin: [100 px, 160 px], direction: [1, 0], scale: 10 px/mm}
    range: [0 mm, 30 mm]
    slide_joint: {name: helix_advance}
    rotation_joint: {name: helix_rotation, sign: -1, offset: 90 deg}
  - name: needle_driver
    marker:
      ring: {outer_diameter: 4 mm, inner_diameter: 2 mm, side: 7 mm}
    axis: {origin: [100 px, 400 px], direction: [1, 0], scale: 10 px/mm, perspective: 0.5 1/m}
    range: [0 mm, 30 mm]
    slide_joint: {name: needle_driver, offset: 1 mm}
)";

std::string with(const std::string& part, const std::string& other) {
  std::string text = kText;
  const std::size_t at = text.find(part);
  EXPECT_NE(at, std::string::npos) << part;
  return at == std::string::npos ? text : text.replace(at, part.size(), other);
}

std::string errorOf(const std::string& text) {
  return vibe::errorOf([&] { VisionConfig::parse(text, "rig.yaml"); });
}

TEST(VisionConfig, UnitsAreConverted) {
  const VisionConfig config = VisionConfig::parse(kText, "rig.yaml");
  ASSERT_EQ(config.instruments.size(), 2U);
  EXPECT_EQ(config.camera.height, 544);
  EXPECT_DOUBLE_EQ(config.camera.cx, 363.5);
  const InstrumentConfig &helix = config.instruments[0], &driver = config.instruments[1];
  EXPECT_DOUBLE_EQ(helix.axis.pixels_per_metre, 1e4);
  EXPECT_DOUBLE_EQ(helix.upper, 0.03);
  EXPECT_DOUBLE_EQ(helix.rotation_offset, M_PI / 2);
  EXPECT_EQ(helix.rotation_sign, -1);
  EXPECT_EQ(driver.slide_joint, "needle_driver");
  EXPECT_DOUBLE_EQ(driver.slide_offset, 1e-3);
  EXPECT_DOUBLE_EQ(driver.axis.perspective, 0.5);
}

TEST(VisionConfig, WhatIsLeftOutHasTheDefaultsOfTheHeader) {
  const VisionConfig config = VisionConfig::parse(kText, "rig.yaml");
  EXPECT_EQ(config.blur, VisionConfig{}.blur);
  EXPECT_EQ(config.noise.gain, PixelNoise{}.gain);
  EXPECT_EQ(config.gates.min_contrast, GateConfig{}.min_contrast);
  EXPECT_EQ(config.instruments[0].motion.max_speed, MotionLimits{}.max_speed);
  EXPECT_EQ(std::get<SleeveDesign>(config.instruments[0].marker).bars.size(), defaultSleeve().bars.size());
  EXPECT_FALSE(config.camera.isDistorted());
}

TEST(VisionConfig, InstrumentsAreFoundByName) {
  const VisionConfig config = VisionConfig::parse(kText, "rig.yaml");
  EXPECT_EQ(config.indexOf("needle_driver"), 1U);
  EXPECT_ERROR(config.indexOf("needle_drive"), "did you mean 'needle_driver'?");
}

TEST(VisionConfig, TheAxisMayBeMissingBeforeTheCalibrationOnly) {
  const std::string text = with("    axis: {origin: [100 px, 160 px], direction: [1, 0], scale: 10 px/mm}\n", "");
  EXPECT_EQ(errorOf(text), "rig.yaml:6: instruments[0]: lacks the key 'axis'; add it below");
  EXPECT_FALSE(VisionConfig::parse(text, "rig.yaml", AxisRule::Optional).instruments[0].axis.isCalibrated());
}

TEST(VisionConfig, TheShippedRigIsTheStandardSyntheticOne) {
  const VisionConfig shipped = VisionConfig::load("../config/rig.yaml");
  EXPECT_EQ(toYaml(shipped), toYaml(nominalConfig(standardScene())));
}

TEST(VisionConfig, AMissingFileIsNamed) {
  EXPECT_ERROR(VisionConfig::load("/nowhere/rig.yaml"), "/nowhere/rig.yaml: cannot be opened");
}

struct Mistake {
  const char* part;
  const char* other;
  const char* sentence;
};

void PrintTo(const Mistake& mistake, std::ostream* stream) {
  *stream << mistake.other;
}

class ConfigMistakes : public testing::TestWithParam<Mistake> {};

TEST_P(ConfigMistakes, AreNamedWithLineKeyAndRemedy) {
  const std::string error = errorOf(with(GetParam().part, GetParam().other));
  EXPECT_EQ(error.rfind("rig.yaml:", 0), 0U) << error;
  EXPECT_NE(error.find(GetParam().sentence), std::string::npos) << error;
}

INSTANTIATE_TEST_SUITE_P(
    VisionConfig, ConfigMistakes,
    testing::Values(
        Mistake{"range: [0", "rnage: [0", "10: instruments[0].rnage: is not a known key; did you mean 'range'?"},
        Mistake{"size: [728, 544]", "size: [728]", "2: camera.size: has 1 values; write width and height"},
        Mistake{"size: [728, 544]", "size: [728.5, 544]", "is not a whole number"},
        Mistake{"2500 px, 2500 px", "25 mm, 25 mm", "'25 mm' is a length, but it must be a length in the image"},
        Mistake{"2500 px, 2500 px", "nan, 2500", "is not finite"},
        Mistake{"2500 px, 2500 px", "0, 2500", "is out of range"},
        Mistake{"2500 px, 2500 px", "16, 16", "which no lens has; write it in pixels"},
        Mistake{"  centre: [363.5 px, 271.5 px]\n", "", "camera: lacks the key 'centre'"},
        Mistake{"  centre:", "  distortion: [-40, 0, 0, 0, 0]\n  centre:", "folds the image over"},
        Mistake{"  centre:", "  distortion: [0.1]\n  centre:", "has 1 values; write 5"},
        Mistake{"  centre:", "  noise: {gain: -1}\n  centre:", "camera.noise.gain: '-1' is out of range"},
        Mistake{"instruments:", "gates: {max_tilt: 20 mm}\ninstruments:", "it must be an angle"},
        Mistake{"      sleeve: {}", "      sleeve: {}\n      ring: {}", "names 2 markers; write one of"},
        Mistake{"      sleeve: {}", "      tag: {}", "known are ring, sleeve, apriltag, aruco"},
        Mistake{"      sleeve: {}", "      apriltag: {id: 587, side: 4 mm}", "586"},
        Mistake{"      sleeve: {}", "      aruco: {id: 7}", "side"},
        Mistake{"      sleeve: {}", "      aruco: {id: 7, side: 4 mm}",
                "a flat tag does not show the rotation of a rod"},
        Mistake{"      sleeve: {}", "      sleeve: {length: 2 mm}", "8: instruments[0].marker.sleeve"},
        Mistake{"inner_diameter: 2 mm", "inner_diameter: 5 mm", "15: instruments[1].marker.ring"},
        Mistake{"direction: [1, 0]", "direction: [0, 0]", "has no direction"},
        Mistake{"scale: 10 px/mm", "scale: 10 mm", "must be a scale of an image"},
        Mistake{"scale: 10 px/mm", "scale: 10", "'10' is out of range"},
        Mistake{"origin: [100 px, 160 px]", "origin: [100 px, 1600 px]", "lies outside of the image of 728 x 544 px"},
        Mistake{"perspective: 0.5 1/m", "perspective: -40 1/m", "would be behind the camera"},
        Mistake{"range: [0 mm, 30 mm]", "range: [30 mm, 0 mm]", "does not have its lower end first"},
        Mistake{"name: needle_driver\n", "name: helix\n", "has the name 'helix' a second time"},
        Mistake{"{name: needle_driver,", "{name: helix_rotation,", "moves the joint 'helix_rotation'"},
        Mistake{"sign: -1", "sign: 2", "'2' is not known here"},
        Mistake{"{name: needle_driver, offset: 1 mm}", "{name: needle_driver}\n    rotation_joint: {name: r}",
                "a ring does not show the rotation"},
        Mistake{"{name: helix_advance}", "{name: helix_advance, offset: 1 deg}", "must be a length"}));

TEST(VisionConfig, NoInstrumentOrTooManyIsAnError) {
  const std::string text = kText;
  const std::string head = text.substr(0, text.find("instruments:"));
  EXPECT_NE(errorOf(head + "instruments: []\n").find("has 0 instruments"), std::string::npos);
  std::string many = head + "instruments:\n";
  for (int i = 0; i < 9; ++i) many += "  - name: a\n";
  EXPECT_NE(errorOf(many).find("has 9 instruments"), std::string::npos);
}

}  // namespace
}  // namespace vibe::vision::vision_config_test
