#include <gtest/gtest.h>

#include "config/random_config.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_vision/config/vision_config.hpp"

namespace vibe::vision::config_round_trip_test {
namespace {

void write(const MarkerDesign& marker, std::ostream& out) {
  if (const auto* ring = std::get_if<RingDesign>(&marker)) {
    out << "ring " << ring->outer_diameter << " " << ring->inner_diameter << " " << ring->side;
  } else if (const auto* tag = std::get_if<TagDesign>(&marker)) {
    out << tagFamilyName(tag->family) << " " << tag->id << " " << tag->side;
  } else {
    const auto& sleeve = std::get<SleeveDesign>(marker);
    out << "sleeve " << sleeve.diameter << " " << sleeve.length << " " << sleeve.helix_begin << " " << sleeve.helix_end
        << " " << sleeve.helix_pitch << " " << sleeve.helix_duty;
    for (const Bar& bar : sleeve.bars) out << " " << bar.begin << " " << bar.end;
  }
}

/// Every number of a configuration, to the bit.
std::string bitsOf(const VisionConfig& config) {
  std::ostringstream out;
  out << std::hexfloat;
  const CameraModel& c = config.camera;
  for (const double number :
       {c.fx, c.fy, c.cx, c.cy, c.reprojection_rms, config.noise.gain, config.noise.read, config.blur,
        config.gates.min_contrast, config.gates.min_visible, config.gates.max_scale_error, config.gates.max_tilt})
    out << number << " ";
  for (const double number : c.distortion) out << number << " ";
  out << c.width << " " << c.height << "\n";
  for (const InstrumentConfig& i : config.instruments) {
    write(i.marker, out);
    out << "\n" << i.name << " " << i.axis.origin << " " << i.axis.direction << " " << i.axis.covariance << "\n";
    for (const double number :
         {i.axis.pixels_per_metre, i.axis.perspective, i.axis.residual_rms, i.lower, i.upper, i.lateral_tolerance,
          i.ink, i.motion.max_speed, i.motion.max_acceleration, i.motion.max_angular_speed, i.slide_sign,
          i.slide_offset, i.rotation_sign, i.rotation_offset})
      out << number << " ";
    out << i.slide_joint << " " << i.rotation_joint << "\n";
  }
  return out.str();
}

TEST(ConfigRoundTrip, AnyValidConfigurationIsReadBackBitByBit) {
  for (unsigned seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const VisionConfig config = RandomConfig(seed).make();
    ASSERT_EQ(bitsOf(VisionConfig::parse(toYaml(config), "written.yaml")), bitsOf(config));
  }
}

TEST(ConfigRoundTrip, AnAxisThatIsNotCalibratedIsLeftOut) {
  VisionConfig config = RandomConfig(3).make();
  config.instruments[0].axis = {};
  const std::string yaml = toYaml(config);
  EXPECT_EQ(bitsOf(VisionConfig::parse(yaml, "written.yaml", AxisRule::Optional)), bitsOf(config));
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
