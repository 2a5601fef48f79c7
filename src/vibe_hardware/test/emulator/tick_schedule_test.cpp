#include "vibe_hardware/emulator/emulator.hpp"

#include <gtest/gtest.h>

namespace vibe::hardware::tick_schedule_test {
namespace {

TEST(TickSchedule, TakesOneTickPerMillisecond) {
  TickSchedule schedule(100);
  int ticks = 0;
  for (double now = 100; now < 110; now += 0.0005) ticks += schedule.due(now);
  EXPECT_NEAR(ticks, 10000, 1);
  EXPECT_LT(schedule.worstDelay(), 0.0006);
  EXPECT_FALSE(schedule.behind());
  EXPECT_EQ(schedule.dropped(), 0);
}

TEST(TickSchedule, AClockThatGoesSlowTicksLess) {
  TickSchedule schedule(100, 0.01);
  int ticks = 0;
  for (double now = 100; now < 110; now += 0.0005) ticks += schedule.due(now);
  EXPECT_NEAR(ticks, 10000 / 1.01, 1);
}

TEST(TickSchedule, MakesUpForAShortDelayInBursts) {
  TickSchedule schedule(0);
  schedule.due(0);
  EXPECT_EQ(schedule.due(0.2004), TickSchedule::kMaxBurst);
  EXPECT_TRUE(schedule.behind());
  int ticks = 1 + TickSchedule::kMaxBurst;
  while (const int more = schedule.due(0.2004)) ticks += more;
  EXPECT_EQ(ticks, 201);
  EXPECT_FALSE(schedule.behind());
  EXPECT_NEAR(schedule.worstDelay(), 0.1994, 1e-9);
}

TEST(TickSchedule, DropsALongDelay) {
  TickSchedule schedule(0);
  schedule.due(0);
  EXPECT_EQ(schedule.due(60), 1);
  EXPECT_TRUE(schedule.behind());
  EXPECT_NEAR(schedule.dropped(), 59.999, 1e-9);
  EXPECT_EQ(schedule.due(60), 0);
  EXPECT_NEAR(schedule.next(), 60.001, 1e-9);
}

}  // namespace
}  // namespace vibe::hardware::tick_schedule_test
