#include "vibe_core/metrics/smoothness.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "metrics/motions.hpp"
#include "vibe_testing/allocation_count.hpp"

namespace vibe::spectral_arc_length_test {
namespace {

using test::publishedBell;
using test::sampleReach;

/// Magnitude spectrum of a minimum-jerk reach over its value at 0: the transform of (1 - x^2)^2 on [-1, 1] is
/// 15 j_2(k) / k^2 with the spherical Bessel function j_2 and k = pi frequency duration.
double reachSpectrum(double k) {
  if (k < 0.05) return 1 - k * k / 14;  // the next term is k^4 / 504
  const double j2 = (3 / (k * k * k) - 1 / k) * std::sin(k) - 3 / (k * k) * std::cos(k);
  return 15 * std::abs(j2) / (k * k);
}

/// Arc length of that spectrum without any Fourier transform, up to the last multiple of `grid` where it is 0.05.
double reachArcLength(double grid) {
  double end = 0;
  for (int i = 1; i * grid < 60; ++i)
    if (reachSpectrum(i * grid) >= 0.05) end = i * grid;
  double sum = 0;
  constexpr int kPieces = 20000;
  for (int i = 0; i < kPieces; ++i)
    sum += std::hypot(1.0 / kPieces, reachSpectrum((i + 1) * end / kPieces) - reachSpectrum(i * end / kPieces));
  return -sum;
}

std::vector<double> twoReaches(double gap) {
  std::vector<double> speed = sampleReach(0.1, 1, 0.01);
  speed.insert(speed.end(), std::lround(gap / 0.01), 0.0);
  const auto second = sampleReach(0.1, 1, 0.01);
  speed.insert(speed.end(), second.begin(), second.end());
  return speed;
}

TEST(SpectralArcLength, agreesWithThePublishedProgram) {
  EXPECT_NEAR(*spectralArcLength(publishedBell(), 0.01), -1.41403, 5e-6);
}

TEST(SpectralArcLength, ofAReachIsTheArcLengthOfItsAnalyticSpectrum) {
  EXPECT_NEAR(reachArcLength(1e-4), -1.408, 5e-4);
  // 2001 samples padded to 2048 * 16: the frequencies are 1 / (32768 * 1 ms) apart, 0.19 in k
  const double grid = M_PI * 2 / 32.768;
  EXPECT_NEAR(*spectralArcLength(sampleReach(0.1, 2, 0.001), 0.001), reachArcLength(grid), 5e-4);
}

TEST(SpectralArcLength, doesNotDependOnLengthDurationOrRateButForTheGridOfFrequencies) {
  const double one = *spectralArcLength(sampleReach(0.1, 1, 0.01), 0.01);
  EXPECT_NEAR(*spectralArcLength(sampleReach(7.0, 1, 0.01), 0.01), one, 1e-12);
  for (double duration : {0.6, 2.0, 5.0, 10.0})
    EXPECT_NEAR(*spectralArcLength(sampleReach(0.1, duration, 0.01), 0.01), one, 1e-2) << duration;
  EXPECT_NEAR(*spectralArcLength(sampleReach(0.1, 1, 1.0 / 60), 1.0 / 60), one, 1e-2);
}

TEST(SpectralArcLength, fallsWithEverySubmovementAndWithTheGapBetweenThem) {
  const double one = *spectralArcLength(sampleReach(0.1, 1, 0.01), 0.01);
  const double near = *spectralArcLength(twoReaches(0), 0.01);
  const double apart = *spectralArcLength(twoReaches(1), 0.01);
  EXPECT_LT(near, one - 0.5);
  EXPECT_LT(apart, near - 0.5);
}

TEST(SpectralArcLength, fallsMonotonicallyWithTremor) {
  double last = 0;
  for (double tremor : {0.0, 0.01, 0.02, 0.04, 0.08}) {  // [m/s], a reach has 0.094 at most
    std::vector<double> speed = sampleReach(0.1, 2, 0.01);
    for (std::size_t i = 0; i < speed.size(); ++i)
      speed[i] = std::abs(speed[i] + tremor * std::sin(2 * M_PI * 9 * 0.01 * static_cast<double>(i)));
    const double now = *spectralArcLength(speed, 0.01);
    EXPECT_LT(now, last) << tremor;
    last = now;
  }
}

TEST(SpectralArcLength, ignoresWhatIsFasterThanTenHertz) {
  std::vector<double> speed = sampleReach(0.1, 2, 0.001);
  const double smooth = *spectralArcLength(speed, 0.001);
  for (std::size_t i = 0; i < speed.size(); ++i)
    speed[i] += 0.08 * (1 + std::sin(2 * M_PI * 0.015 * static_cast<double>(i)));
  for (double& v : speed) v -= 0.08;
  EXPECT_NEAR(*spectralArcLength(speed, 0.001), smooth, 0.02);
}

TEST(SpectralArcLength, hasNoValueWithoutMotion) {
  EXPECT_FALSE(spectralArcLength({}, 0.01));
  EXPECT_FALSE(spectralArcLength({0.1}, 0.01));
  EXPECT_FALSE(spectralArcLength(std::vector<double>(100, 0.0), 0.01));
  EXPECT_FALSE(spectralArcLength(sampleReach(0.1, 1, 0.01), 0));
  EXPECT_FALSE(spectralArcLength({0.1, std::numeric_limits<double>::quiet_NaN(), 0.1}, 0.01));
  EXPECT_TRUE(spectralArcLength(std::vector<double>(100, 0.1), 0.01)) << "an even speed has a spectrum";
}

TEST(SpectralArcLength, asksForNoMemoryOnceMade) {
  if (!VIBE_COUNTS_ALLOCATIONS) GTEST_SKIP() << "nothing counts allocations here";
  SpectralArcLength arc(2048);
  std::vector<std::vector<double>> records;
  for (int n : {2, 3, 5, 100, 129, 1000, 1025, 2048}) records.emplace_back(n, 0.1);
  const long before = test::allocations;
  double sum = 0;
  for (const auto& record : records) sum += arc.of(record, 1.0 / 60).value_or(0);
  EXPECT_EQ(test::allocations, before);
  EXPECT_LT(sum, 0);
  arc.of(std::vector<double>(5000, 0.1), 1.0 / 60);
  EXPECT_GT(test::allocations, before) << "the count counts nothing";
}

}  // namespace
}  // namespace vibe::spectral_arc_length_test
