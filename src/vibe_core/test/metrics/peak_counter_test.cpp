#include "vibe_core/metrics/smoothness.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace vibe::peak_counter_test {
namespace {

int count(const std::vector<double>& speed, double threshold = 0.1) {
  PeakCounter peaks(threshold);
  for (double v : speed) peaks.add(v);
  peaks.finish();
  return peaks.count();
}

TEST(PeakCounter, countsPeaksAboveTheThreshold) {
  EXPECT_EQ(count({}), 0);
  EXPECT_EQ(count({0, 0, 0}), 0);
  EXPECT_EQ(count({0, 1, 0}), 1);
  EXPECT_EQ(count({0, 1, 0, 1, 0}), 2);
  EXPECT_EQ(count({0, 0.09, 0, 1, 0}), 1);
  EXPECT_EQ(count({0, 0.09, 0, 0.09, 0}), 0);
}

TEST(PeakCounter, asksForARiseAndAFallOfAFifth) {
  EXPECT_EQ(count({0, 1, 0.85, 1, 0}), 1);
  EXPECT_EQ(count({0, 1, 0.75, 1, 0}), 2);
  EXPECT_EQ(count({0, 1, 0.75, 0.9, 0}), 1) << "0.75 to 0.9 is less than a fifth of 0.9";
}

TEST(PeakCounter, countsAPeakWithoutAFallOnlyAtTheEnd) {
  PeakCounter peaks(0.1);
  for (double v : {0.0, 0.5, 1.0}) peaks.add(v);
  EXPECT_EQ(peaks.count(), 0);
  peaks.finish();
  EXPECT_EQ(peaks.count(), 1);
  peaks.finish();
  EXPECT_EQ(peaks.count(), 1);
}

TEST(PeakCounter, findsTwoPeaksPerCycleOfASine) {
  std::vector<double> speed;
  for (int i = 0; i <= 1000; ++i) speed.push_back(std::abs(std::cos(2 * M_PI * 5 * i / 1000.0 + 0.3)));
  EXPECT_EQ(count(speed), 11) << "ten zeros lie between eleven arches";
}

}  // namespace
}  // namespace vibe::peak_counter_test
