#include "vibe_graphics/geometry/colour_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <utility>

namespace vibe::graphics::colour_map_test {
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

using ColourOf = std::function<PackedColour(double)>;  // of a value between 0 and 1

/// Smallest and largest of 16 equal steps, as a share of the mean step in lightness. Even steps: both near 1; a map
/// that gets darker somewhere: below 0.
std::pair<double, double> stepsOfLightness(const ColourOf& colour) {
  const double mean = (lightness(colour(1)) - lightness(colour(0))) / 16;
  double min = HUGE_VAL, max = -HUGE_VAL;
  for (int k = 0; k < 16; ++k) {
    const double step = (lightness(colour((k + 1) / 16.0)) - lightness(colour(k / 16.0))) / mean;
    min = std::min(min, step), max = std::max(max, step);
  }
  return {min, max};
}

/// The rainbow of old: blue, cyan, green, yellow, red.
PackedColour rainbow(double value) {
  return packed(std::clamp(4 * value - 2, 0.0, 1.0), std::clamp(2 - std::abs(4 * value - 2), 0.0, 1.0),
                std::clamp(2 - 4 * value, 0.0, 1.0));
}

class EveryMap : public testing::TestWithParam<std::string> {};

TEST_P(EveryMap, GetsLighterInEvenSteps) {
  const ColourMap map(GetParam(), 0, 1);
  const auto [min, max] = stepsOfLightness([&map](double value) { return map.at(value); });
  EXPECT_GT(lightness(map.at(1)) - lightness(map.at(0)), 70);
  EXPECT_GT(min, 0.5);
  EXPECT_LT(max, 1.4);  // measured: 0.510 to 1.257 for magma, 0.885 to 1.287 for the others
}

INSTANTIATE_TEST_SUITE_P(Maps, EveryMap, testing::ValuesIn(colourMapNames()));

TEST(ColourMap, RainbowFailsTheCheckOfEvenSteps) {
  const auto [min, max] = stepsOfLightness(rainbow);
  EXPECT_LT(min, 0);  // its upper half gets darker
  EXPECT_GT(max, 1.6);
}

// The values that matplotlib gives for viridis, magma and cividis at 0.25, 0.5 and 0.75.
TEST(ColourMap, ColoursAreThoseOfMatplotlib) {
  const std::map<std::string, std::array<std::array<int, 3>, 3>> expected{
      {"viridis", {{{59, 82, 139}, {33, 145, 140}, {94, 201, 98}}}},
      {"magma", {{{81, 18, 124}, {183, 55, 121}, {252, 137, 97}}}},
      {"cividis", {{{67, 78, 108}, {125, 124, 120}, {188, 174, 108}}}}};
  for (const auto& [name, colours] : expected)
    for (std::size_t k = 0; k < 3; ++k) {
      const PackedColour colour = ColourMap(name, 0, 1).at(0.25 * static_cast<double>(k + 1));
      for (std::size_t channel = 0; channel < 3; ++channel)
        EXPECT_NEAR(static_cast<int>(colour >> (8 * channel) & 255U), colours[k][channel], 2) << name << " " << k;
    }
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
}  // namespace vibe::graphics::colour_map_test
