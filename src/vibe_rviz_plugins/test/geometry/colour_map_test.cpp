#include "vibe_rviz_plugins/geometry/colour_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace vibe {
namespace {

double linear(double channel) {
  return channel <= 0.04045 ? channel / 12.92 : std::pow((channel + 0.055) / 1.055, 2.4);
}

// Lightness L* of CIE 1976, 0 black to 100 white.
double lightness(PackedColour colour) {
  const double luminance = 0.2126 * linear((colour & 255U) / 255.0) + 0.7152 * linear((colour >> 8 & 255U) / 255.0) +
                           0.0722 * linear((colour >> 16 & 255U) / 255.0);
  return luminance > 0.008856 ? 116 * std::cbrt(luminance) - 16 : 903.3 * luminance;
}

class EveryMap : public testing::TestWithParam<std::string> {};

TEST_P(EveryMap, GetsLighterInEvenSteps) {
  const ColourMap map(GetParam(), 0, 1);
  const double whole = lightness(map.at(1)) - lightness(map.at(0));
  EXPECT_GT(whole, 70);
  for (int k = 0; k < 16; ++k) {
    const double part = lightness(map.at((k + 1) / 16.0)) - lightness(map.at(k / 16.0));
    EXPECT_GT(part, 0.5 * whole / 16) << k;
    EXPECT_LT(part, 1.6 * whole / 16) << k;
  }
}

INSTANTIATE_TEST_SUITE_P(Maps, EveryMap, testing::ValuesIn(colourMapNames()));

TEST(ColourMap, ARainbowWouldNotPass) {
  const double yellow = lightness(packed(1, 1, 0)), red = lightness(packed(1, 0, 0));
  EXPECT_LT(red, yellow);  // the upper half of the rainbow gets darker
}

TEST(ColourMap, EndsHoldWhatLiesOutside) {
  const ColourMap map("viridis", 2, 4);
  EXPECT_EQ(map.at(-100), map.steps().front());
  EXPECT_EQ(map.at(1e30), map.steps().back());
  EXPECT_EQ(map.at(std::numeric_limits<double>::quiet_NaN()), map.steps().front());
  EXPECT_EQ(map.at(3), map.steps()[128]);
  EXPECT_DOUBLE_EQ(map.min(), 2);
  EXPECT_DOUBLE_EQ(map.max(), 4);
}

TEST(ColourMap, RangeWithoutLengthIsDrawnDark) {
  const ColourMap map("viridis", 1, 1);
  EXPECT_EQ(map.at(0), map.steps().front());
  EXPECT_EQ(map.at(5), map.steps().front());
}

TEST(ColourMap, MapsDiffer) {
  EXPECT_NE(ColourMap("magma", 0, 1).at(0.5), ColourMap("viridis", 0, 1).at(0.5));
}

}  // namespace
}  // namespace vibe
