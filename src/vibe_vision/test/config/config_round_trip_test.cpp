#include <gtest/gtest.h>

#include <cmath>

#include "config/random_config.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_vision/config/vision_config.hpp"

namespace vibe::vision::config_round_trip_test {
namespace {

void expectEqual(const MarkerDesign& a, const MarkerDesign& b) {
  ASSERT_EQ(a.index(), b.index());
  if (const auto* ring = std::get_if<RingDesign>(&a)) {
    const auto& other = std::get<RingDesign>(b);
    EXPECT_EQ(ring->outer_diameter, other.outer_diameter);
    EXPECT_EQ(ring->inner_diameter, other.inner_diameter);
    EXPECT_EQ(ring->side, other.side);
    return;
  }
  if (const auto* tag = std::get_if<TagDesign>(&a)) {
    const auto& other = std::get<TagDesign>(b);
    EXPECT_EQ(tag->family, other.family);
    EXPECT_EQ(tag->id, other.id);
    EXPECT_EQ(tag->side, other.side);
    return;
  }
  const auto &one = std::get<SleeveDesign>(a), &other = std::get<SleeveDesign>(b);
  EXPECT_EQ(one.diameter, other.diameter);
  EXPECT_EQ(one.length, other.length);
  ASSERT_EQ(one.bars.size(), other.bars.size());
  for (std::size_t i = 0; i < one.bars.size(); ++i) {
    EXPECT_EQ(one.bars[i].begin, other.bars[i].begin);
    EXPECT_EQ(one.bars[i].end, other.bars[i].end);
  }
  EXPECT_EQ(one.helix_begin, other.helix_begin);
  EXPECT_EQ(one.helix_end, other.helix_end);
  EXPECT_EQ(one.helix_pitch, other.helix_pitch);
  EXPECT_EQ(one.helix_duty, other.helix_duty);
}

void expectEqual(const SlideAxis& a, const SlideAxis& b) {
  EXPECT_EQ(a.origin, b.origin);
  EXPECT_EQ(a.direction, b.direction);
  EXPECT_EQ(a.pixels_per_metre, b.pixels_per_metre);
  EXPECT_EQ(a.perspective, b.perspective);
  EXPECT_EQ(a.residual_rms, b.residual_rms);
  EXPECT_EQ(a.covariance, b.covariance);
}

void expectEqual(const InstrumentConfig& a, const InstrumentConfig& b) {
  EXPECT_EQ(a.name, b.name);
  expectEqual(a.marker, b.marker);
  expectEqual(a.axis, b.axis);
  EXPECT_EQ(a.lower, b.lower);
  EXPECT_EQ(a.upper, b.upper);
  EXPECT_EQ(a.lateral_tolerance, b.lateral_tolerance);
  EXPECT_EQ(a.ink, b.ink);
  EXPECT_EQ(a.motion.max_speed, b.motion.max_speed);
  EXPECT_EQ(a.motion.max_acceleration, b.motion.max_acceleration);
  EXPECT_EQ(a.motion.max_angular_speed, b.motion.max_angular_speed);
  EXPECT_EQ(a.slide_joint, b.slide_joint);
  EXPECT_EQ(a.slide_sign, b.slide_sign);
  EXPECT_EQ(a.slide_offset, b.slide_offset);
  EXPECT_EQ(a.rotation_joint, b.rotation_joint);
  EXPECT_EQ(a.rotation_sign, b.rotation_sign);
  EXPECT_EQ(a.rotation_offset, b.rotation_offset);
}

void expectEqual(const VisionConfig& a, const VisionConfig& b) {
  EXPECT_EQ(a.camera.width, b.camera.width);
  EXPECT_EQ(a.camera.height, b.camera.height);
  EXPECT_EQ(a.camera.fx, b.camera.fx);
  EXPECT_EQ(a.camera.fy, b.camera.fy);
  EXPECT_EQ(a.camera.cx, b.camera.cx);
  EXPECT_EQ(a.camera.cy, b.camera.cy);
  EXPECT_EQ(a.camera.distortion, b.camera.distortion);
  EXPECT_EQ(a.camera.reprojection_rms, b.camera.reprojection_rms);
  EXPECT_EQ(a.noise.gain, b.noise.gain);
  EXPECT_EQ(a.noise.read, b.noise.read);
  EXPECT_EQ(a.blur, b.blur);
  EXPECT_EQ(a.gates.min_contrast, b.gates.min_contrast);
  EXPECT_EQ(a.gates.min_visible, b.gates.min_visible);
  EXPECT_EQ(a.gates.max_scale_error, b.gates.max_scale_error);
  EXPECT_EQ(a.gates.max_tilt, b.gates.max_tilt);
  ASSERT_EQ(a.instruments.size(), b.instruments.size());
  for (std::size_t i = 0; i < a.instruments.size(); ++i) expectEqual(a.instruments[i], b.instruments[i]);
}

TEST(ConfigRoundTrip, AnyValidConfigurationIsReadBackBitByBit) {
  for (unsigned seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const VisionConfig config = RandomConfig(seed).make();
    expectEqual(VisionConfig::parse(toYaml(config), "written.yaml"), config);
    if (HasFailure()) return;
  }
}

TEST(ConfigRoundTrip, AnAxisThatIsNotCalibratedIsLeftOut) {
  VisionConfig config = RandomConfig(3).make();
  config.instruments[0].axis = {};
  const std::string yaml = toYaml(config);
  expectEqual(VisionConfig::parse(yaml, "written.yaml", AxisRule::Optional), config);
  EXPECT_THROW(VisionConfig::parse(yaml, "written.yaml"), Error);
}

TEST(ConfigRoundTrip, ADirectionOfAnotherLengthIsNormalised) {
  VisionConfig config = RandomConfig(4).make();
  config.instruments[0].axis.direction = {3, 4};
  const VisionConfig read = VisionConfig::parse(toYaml(config), "written.yaml");
  EXPECT_TRUE(read.instruments[0].axis.direction.isApprox(Eigen::Vector2d(0.6, 0.8), 1e-15));
}

}  // namespace
}  // namespace vibe::vision::config_round_trip_test
