#include "vibe_graphics/geometry/endoscope_optics.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace vibe::graphics::endoscope_light_test {
namespace {

TEST(EndoscopeLight, DefaultIsThatOfTheLiveViewToTheBit) {
  const EndoscopeLight light;
  EXPECT_EQ(lightColour(light.temperature), Eigen::Vector3d(1, 1, 1));
  for (const LightGuide& guide : light.guides) {
    EXPECT_EQ(static_cast<float>(coneOf(light, guide).x()), 0.15F);
    EXPECT_EQ(static_cast<float>(coneOf(light, guide).y()), 0.35F);
  }
  EXPECT_NE(lightColour(5900), Eigen::Vector3d(1, 1, 1));  // control
}

// Wien's law, which Planck's becomes at short wavelengths: the logarithm of a ratio is linear in 1 / temperature.
TEST(EndoscopeLight, ColourFollowsTheTemperature) {
  for (const double temperature : {4800.0, 5300.0, 7000.0}) {
    const Eigen::Vector3d colour = lightColour(temperature);
    const double step = 0.014388 * (1 / temperature - 1 / EndoscopeLight::kBalanced);
    EXPECT_EQ(colour[1], 1);
    EXPECT_NEAR(std::log(colour[0]), step * (1 / 550e-9 - 1 / 610e-9), 0.01) << temperature;
    EXPECT_NEAR(std::log(colour[2]), step * (1 / 550e-9 - 1 / 465e-9), 0.01) << temperature;
    EXPECT_GT(std::abs(std::log(colour[2])), 0.04);  // control: more than the tolerance
  }
  EXPECT_GT(lightColour(4800)[0], lightColour(4800)[2]);  // warm light is red
  EXPECT_LT(lightColour(7000)[0], lightColour(7000)[2]);
}

TEST(EndoscopeLight, ConeKeepsTheLightAhead) {
  EndoscopeLight light;
  for (const double sideward : {0.0, 0.15, 0.45, 1.0}) {
    light.sideward = sideward;
    const Eigen::Vector2d cone = coneOf(light, {0, 0, 1.4});
    EXPECT_NEAR(cone.sum(), 0.7, 1e-12);
    EXPECT_NEAR(cone.x(), 0.7 * sideward, 1e-12);
  }
}

}  // namespace
}  // namespace vibe::graphics::endoscope_light_test
