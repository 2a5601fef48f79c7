#include "vibe_graphics/geometry/mucosa_pattern.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace vibe::graphics::mucosa_pattern_test {
namespace {

int at(const MucosaPattern& pattern, int x, int y, int z, int channel) {
  const int n = pattern.size;
  return pattern.voxels[static_cast<std::size_t>(4 * ((z % n * n + y % n) * n + x % n) + channel)];
}

/// Mean difference of neighbours in x, from one plane of voxels to the next.
double change(const MucosaPattern& pattern, int from, int to, int channel) {
  double sum = 0;
  for (int z = 0; z < pattern.size; ++z)
    for (int y = 0; y < pattern.size; ++y)
      sum += std::abs(at(pattern, from, y, z, channel) - at(pattern, to, y, z, channel));
  return sum / (pattern.size * pattern.size);
}

TEST(MucosaPatternTest, RepeatsWithoutASeamAndIsNotConstant) {
  const MucosaPattern pattern = makeMucosaPattern();
  ASSERT_EQ(pattern.voxels.size(), 4u * kPatternSize * kPatternSize * kPatternSize);
  for (int channel = 0; channel < 4; ++channel) {
    double largest = 0;
    for (int x = 0; x + 1 < kPatternSize; ++x) largest = std::max(largest, change(pattern, x, x + 1, channel));
    EXPECT_LE(change(pattern, kPatternSize - 1, kPatternSize, channel), 1.1 * largest) << channel;
    EXPECT_GT(change(pattern, 0, kPatternSize / 2, channel), 1.0) << channel;
  }
  // control: a piece that does not end with the period has a seam in the smooth noise
  EXPECT_GT(change(pattern, 0, 9, 1), 2 * change(pattern, 0, 1, 1));
}

TEST(MucosaPatternTest, IsTheSameEveryTime) {
  EXPECT_TRUE(makeMucosaPattern().voxels == makeMucosaPattern().voxels);
}

TEST(MucosaPatternTest, CoarserLevelsKeepTheMean) {
  MucosaPattern pattern = makeMucosaPattern();
  const auto mean = [](const MucosaPattern& p) {
    double sum = 0;
    for (std::size_t k = 0; k < p.voxels.size(); k += 4) sum += p.voxels[k];
    return sum / (static_cast<double>(p.voxels.size()) / 4);
  };
  const double whole = mean(pattern);
  while (pattern.size > 1) pattern = halved(pattern);
  EXPECT_NEAR(mean(pattern), whole, 2);
  EXPECT_GT(whole, 30);
  EXPECT_LT(whole, 225);
}

/// Largest error of a linear interpolation between the ends of 1,000 edges of this length [m], in their middle.
float interpolationError(float length) {
  std::mt19937 random(1);
  const auto vector = [&random] {
    const auto coordinate = [&random] { return static_cast<float>(random()) / 4294967296.0F - 0.5F; };
    const float x = coordinate(), y = coordinate();
    return Eigen::Vector3f(x, y, coordinate());
  };
  float worst = 0;
  for (int k = 0; k < 1000; ++k) {
    const Eigen::Vector3f middle = 0.3F * vector(), half = 0.5F * length * vector().normalized();
    const float ends = 0.5F * (broadPattern(middle + half) + broadPattern(middle - half));
    worst = std::max(worst, std::abs(broadPattern(middle) - ends));
  }
  return worst;
}

TEST(MucosaPatternTest, BlotchesAreWideEnoughToBeInterpolatedBetweenVertices) {
  EXPECT_LT(interpolationError(2e-3F), 0.02F);   // edges of the drawn wall; a byte of colour is 0.004
  EXPECT_GT(interpolationError(10e-3F), 0.05F);  // control
}

}  // namespace
}  // namespace vibe::graphics::mucosa_pattern_test
