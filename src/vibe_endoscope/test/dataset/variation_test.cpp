// What a seed draws: ranges, repetition, and that nothing stays the same from seed to seed.
#include "dataset/variation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace vibe::endoscope::variation_test {
namespace {

constexpr double kLens = 140 * graphics::kDegree;

struct Quantity {
  std::string name;
  double value, min, max;
};

/// Everything that a seed varies, with the ranges that are documented.
std::vector<Quantity> quantitiesOf(std::uint32_t seed) {
  const Variation v = variationOf(seed, kLens);
  const SensorStyle& s = v.sensor;
  const graphics::MucosaLook& m = v.mucosa;
  const auto& [right, left] = v.light.guides;
  return {{"field of view", v.field_of_view / graphics::kDegree, 135, 145},
          {"roll", v.roll / graphics::kDegree, -5, 5},
          {"pitch", v.pitch / graphics::kDegree, -2, 2},
          {"yaw", v.yaw / graphics::kDegree, -2, 2},
          {"exposure", s.exposure, 0.7, 1.4},
          {"red", s.red_gain, 0.9, 1.1},
          {"blue", s.blue_gain, 0.9, 1.1},
          {"vignetting", s.vignetting, 0.05, 0.4},
          {"blur", s.blur, 0.3, 0.9},
          {"distortion", s.distortion, -0.03, 0.03},
          {"full well", s.full_well, 2000, 12000},
          {"read noise", s.read_noise, 0.001, 0.006},
          {"shift x", m.shift.x(), 0, 0.5},
          {"shift y", m.shift.y(), 0, 0.5},
          {"shift z", m.shift.z(), 0, 0.5},
          {"areae", m.areae_size, 2e-3, 5e-3},
          {"paleness", m.paleness, 0.8, 1.25},
          {"yellowness", m.yellowness, 0.92, 1.09},
          {"vessels", m.vessels, 0.3, 2},
          {"wetness", m.wetness, 0.6, 1.6},
          {"mucus", m.mucus, -0.06, 0.08},
          {"right guide x", right.right, 2.8e-3, 3.8e-3},
          {"right guide y", right.up, 0, 1.25e-3},
          {"left guide x", left.right, -3.8e-3, -2.8e-3},
          {"left guide y", left.up, 0, 1.25e-3},
          {"guides", right.strength / left.strength, 0.6, 1.67},
          {"sideward", v.light.sideward, 0.15, 0.45},
          {"temperature", v.light.temperature, 4800, 7000}};
}

TEST(Variation, FillsItsRangesAndStaysInThem) {
  constexpr std::uint32_t kSeeds = 2000;
  std::vector<std::vector<double>> values(quantitiesOf(1).size());
  for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
    const std::vector<Quantity> drawn = quantitiesOf(seed);
    for (std::size_t k = 0; k < drawn.size(); ++k) values[k].push_back(drawn[k].value);
  }
  const std::vector<Quantity> ranges = quantitiesOf(1);
  for (std::size_t k = 0; k < ranges.size(); ++k) {
    const auto [least, most] = std::minmax_element(values[k].begin(), values[k].end());
    const double width = ranges[k].max - ranges[k].min;
    EXPECT_GE(*least, ranges[k].min - 1e-6 * width) << ranges[k].name;
    EXPECT_LE(*most, ranges[k].max + 1e-6 * width) << ranges[k].name;
    EXPECT_LT(*least, ranges[k].min + 0.02 * width) << ranges[k].name;  // so a narrower range would be noticed
    EXPECT_GT(*most, ranges[k].max - 0.02 * width) << ranges[k].name;
  }
}

TEST(Variation, SameSeedSameValuesOtherSeedOtherValues) {
  constexpr std::uint32_t kSeeds = 200;
  const std::vector<Quantity> first = quantitiesOf(1);
  for (std::size_t k = 0; k < first.size(); ++k) {
    EXPECT_EQ(first[k].value, quantitiesOf(1)[k].value) << first[k].name;
    std::set<double> different;
    for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) different.insert(quantitiesOf(seed)[k].value);
    EXPECT_EQ(different.size(), kSeeds) << first[k].name;
  }
}

/// Correlation over many seeds of two quantities.
double correlation(std::size_t a, std::size_t b) {
  constexpr std::uint32_t kSeeds = 500;
  double sums[5] = {0, 0, 0, 0, 0};
  for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
    const std::vector<Quantity> q = quantitiesOf(seed);
    const double x = (q[a].value - q[a].min) / (q[a].max - q[a].min) - 0.5;
    const double y = (q[b].value - q[b].min) / (q[b].max - q[b].min) - 0.5;
    sums[0] += x, sums[1] += y, sums[2] += x * x, sums[3] += y * y, sums[4] += x * y;
  }
  const auto covariance = [&](double product, double x, double y) {
    return product / kSeeds - x * y / kSeeds / kSeeds;
  };
  return covariance(sums[4], sums[0], sums[1]) /
         std::sqrt(covariance(sums[2], sums[0], sums[0]) * covariance(sums[3], sums[1], sums[1]));
}

TEST(Variation, QuantitiesOfMucosaAndLightAreIndependent) {
  const std::size_t count = quantitiesOf(1).size();
  for (std::size_t a = 12; a < count; ++a)
    for (std::size_t b = a + 1; b < count; ++b) EXPECT_LT(std::abs(correlation(a, b)), 0.2) << a << " " << b;
  EXPECT_NEAR(correlation(15, 15), 1, 1e-12);  // control
}

// Data sets of earlier versions name their seeds.
TEST(Variation, LensAndSensorAreDrawnFirst) {
  std::mt19937 random(5);
  const auto between = [&](double min, double max) {
    return min + (max - min) * static_cast<double>(random()) / 4294967295.0;
  };
  const Variation drawn = variationOf(5, kLens);
  EXPECT_NEAR(drawn.field_of_view, kLens + between(-5, 5) * graphics::kDegree, 1e-12);
  random.discard(10);
  EXPECT_NEAR(drawn.sensor.read_noise, between(0.001, 0.006), 1e-12);
  EXPECT_GT(std::abs(drawn.sensor.read_noise - between(0.001, 0.006)), 1e-6);  // control: the next number
}

// The lens is 2.5 mm above the axis of an endoscope of 12.6 mm, and a guide is 1.9 mm wide (docs/device.md).
TEST(Variation, GuidesFitIntoTheTipBesideTheLens) {
  const auto farthest = [](const graphics::LightGuide& guide) {
    return std::hypot(guide.right, guide.up + 2.5e-3) + 0.95e-3;
  };
  for (std::uint32_t seed = 1; seed <= 2000; ++seed)
    for (const graphics::LightGuide& guide : variationOf(seed, kLens).light.guides) {
      EXPECT_LT(farthest(guide), 6.3e-3) << seed;
      EXPECT_GT(std::abs(guide.right) - 0.95e-3, 1.4e-3) << seed << ": beside the lens of 2.8 mm";
    }
}

TEST(Variation, GuidesTogetherAreAsStrongAsEver) {
  for (std::uint32_t seed = 1; seed <= 100; ++seed) {
    const auto& [right, left] = variationOf(seed, kLens).light.guides;
    EXPECT_NEAR(right.strength + left.strength, 2, 1e-12);
  }
}

}  // namespace
}  // namespace vibe::endoscope::variation_test
