#include "vibe_core/clocks/step_timer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>
#include <thread>
#include <vector>

namespace vibe::step_timer_test {
namespace {

TEST(DurationHistogram, quantilesOfKnownDistributionAreWithinOnePercent) {
  DurationHistogram histogram;
  std::vector<double> exact;
  exact.reserve(20000);
  std::mt19937 random(1);
  std::lognormal_distribution<double> durations(std::log(0.012), 0.7);
  for (int i = 0; i < 20000; ++i) exact.push_back(durations(random));
  for (double duration : exact) histogram.add(duration);
  std::sort(exact.begin(), exact.end());
  for (double q : {0.01, 0.5, 0.9, 0.99, 0.999}) {
    const double expected = exact[static_cast<std::size_t>(std::ceil(q * 20000.0)) - 1];
    EXPECT_NEAR(histogram.quantile(q), expected, 0.01 * expected) << "q = " << q;
  }
  EXPECT_EQ(histogram.max(), exact.back());
  EXPECT_EQ(histogram.count(), 20000u);
}

TEST(DurationHistogram, p99OfHundredEqualAndOneLongIsTheEqual) {
  DurationHistogram histogram;
  for (int i = 0; i < 100; ++i) histogram.add(0.010);
  histogram.add(1.0);
  EXPECT_NEAR(histogram.quantile(0.99), 0.010, 1e-4);
  EXPECT_NEAR(histogram.quantile(1.0), 1.0, 1e-2);
  EXPECT_EQ(histogram.max(), 1.0);
  EXPECT_NEAR(histogram.mean(), (1.0 + 1.0) / 101, 1e-12);
}

TEST(DurationHistogram, extremesAreKeptAndNothingIsLost) {
  DurationHistogram histogram;
  histogram.add(0.0);
  histogram.add(1e9);
  histogram.add(1e-9);
  EXPECT_EQ(histogram.count(), 3u);
  EXPECT_EQ(histogram.max(), 1e9);
  EXPECT_LE(histogram.quantile(0.5), 1.01e-6);
}

TEST(DurationHistogram, emptyIsZeroAndClearEmpties) {
  DurationHistogram histogram;
  EXPECT_EQ(histogram.quantile(0.5), 0.0);
  histogram.add(1.0);
  EXPECT_GT(histogram.quantile(0.5), 0.0);
  histogram.clear();
  EXPECT_EQ(histogram.quantile(0.5), 0.0);
  EXPECT_EQ(histogram.mean(), 0.0);
}

TEST(StepTimer, sleepingTakesWallTimeButNoCpuTime) {
  StepTimer timer;
  timer.start();
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  timer.stop();
  EXPECT_GE(timer.wall.window.max(), 0.050);
  EXPECT_LT(timer.cpu.window.max(), 0.020);
}

TEST(StepTimer, workTakesCpuTimeAndTheWindowClearsAlone) {
  StepTimer timer;
  timer.start();
  const double end = threadCpuTime() + 0.02;
  while (threadCpuTime() < end) {
  }
  timer.stop();
  EXPECT_GE(timer.cpu.window.max(), 0.02);
  EXPECT_LE(timer.cpu.window.max(), timer.wall.window.max() + 1e-3);
  timer.cpu.window.clear();
  EXPECT_EQ(timer.cpu.window.count(), 0u);
  EXPECT_EQ(timer.cpu.all.count(), 1u);
}

}  // namespace
}  // namespace vibe::step_timer_test
