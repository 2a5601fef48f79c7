#include "simulation/timed_simulation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace vibe::sim::sim_time_test {
namespace {

TEST(SimTime, stampsAreIntegerNanosecondsWithoutDrift) {
  const double period = 1.0 / 60;
  EXPECT_EQ(stampOf(kEpoch, 0, period), 1'000'000'000);
  EXPECT_EQ(stampOf(kEpoch, 1, period), 1'016'666'667);
  EXPECT_EQ(stampOf(kEpoch, 60, period), 2'000'000'000);
  // ten hours later there is still no error; adding rounded periods would be off by 0.7 ms
  EXPECT_EQ(stampOf(kEpoch, 60LL * 36000, period), 36'001'000'000'000);
}

TEST(SimTime, stepAtInvertsStampOf) {
  for (double period : {1.0 / 60, 0.02, 1e-4, 1.0 / 90}) {
    for (std::int64_t step : {0LL, 1LL, 59LL, 12345LL, 5'000'000LL}) {
      EXPECT_EQ(stepAt(kEpoch, stampOf(kEpoch, step, period), period), step) << period;
    }
  }
}

TEST(SimTime, durationsRoundToTheNearestStep) {
  EXPECT_EQ(stepsIn(1.0, 1.0 / 60), 60);
  EXPECT_EQ(stepsIn(3.0, 1.0 / 60), 180);
  EXPECT_EQ(stepsIn(0.0, 1.0 / 60), 0);
}

TEST(TimeLine, goesOnWithoutRepeatingAStampWhenTheStateIsReplaced) {
  TimeLine time(kEpoch, 1.0 / 60);
  const std::int64_t last = time.stamp(100);
  time.continueWith(100, 0, 1.0 / 60);
  EXPECT_EQ(time.stamp(0), stampOf(kEpoch, 101, 1.0 / 60));
  EXPECT_GT(time.stamp(0), last);
  EXPECT_EQ(time.clockStep(0), 101);
  // a snapshot from later than now
  time.continueWith(5, 5000, 1.0 / 60);
  EXPECT_EQ(time.stamp(5000), stampOf(kEpoch, 107, 1.0 / 60));
  EXPECT_EQ(time.stamp(5001), stampOf(kEpoch, 108, 1.0 / 60));
}

TEST(TimeLine, anotherPeriodStartsWhereTheOldOneEnds) {
  TimeLine time(kEpoch, 1.0 / 60);
  time.continueWith(59, 10, 0.02);
  EXPECT_EQ(time.origin(), 2'000'000'000);
  EXPECT_EQ(time.stamp(10), 2'000'000'000);
  EXPECT_EQ(time.stamp(11), 2'020'000'000);
}

TEST(TimeLine, whoKnowsTheOriginFindsEveryStampAndStepAcrossReplacedStates) {
  std::mt19937 random(1);
  int elsewhere = 0;
  for (const double period : {1.0 / 60, 1.0 / 90, 0.02}) {
    TimeLine time(kEpoch, period);
    const std::int64_t origin = time.origin();
    std::int64_t step = 0;
    for (int k = 0; k < 1000; ++k) {
      const std::int64_t before = step + random() % 100;
      step = random() % 2 == 0 ? 0 : random() % 100000;
      const std::int64_t last = time.stamp(before);
      time.continueWith(before, step, period);
      const std::int64_t stamp = time.stamp(step), clock = stepAt(origin, stamp, period);
      ASSERT_EQ(time.origin(), origin);
      ASSERT_EQ(stamp, stampOf(origin, clock, period));
      ASSERT_EQ(clock, stepAt(origin, last, period) + 1);
      const std::int64_t later = time.stamp(step + 77);
      ASSERT_EQ(step + std::llround(1e-9 * static_cast<double>(later - stamp) / period), step + 77);
      elsewhere += clock != step;
    }
  }
  EXPECT_GT(elsewhere, 2900) << "the state's steps have other numbers than the clock's";
}

TEST(TimeLine, shiftMovesEveryStamp) {
  TimeLine time(kEpoch, 0.5);
  time.shiftOrigin(7);
  EXPECT_EQ(time.stamp(2), 2'000'000'007);
}

}  // namespace
}  // namespace vibe::sim::sim_time_test
