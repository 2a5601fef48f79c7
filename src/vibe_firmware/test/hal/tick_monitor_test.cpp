#include "vibe_firmware/hal/application.hpp"

#include <gtest/gtest.h>

namespace vibe_firmware::tick_monitor_test {
namespace {

TEST(TickMonitor, FirstTickIsNeverLate) {
  TickMonitor monitor;
  EXPECT_FALSE(monitor.isLate(123456));
}

TEST(TickMonitor, MoreThanTenPercentIsLate) {
  TickMonitor monitor;
  monitor.isLate(0);
  EXPECT_FALSE(monitor.isLate(1000));
  EXPECT_FALSE(monitor.isLate(2100));
  EXPECT_TRUE(monitor.isLate(3201));
  EXPECT_FALSE(monitor.isLate(4201));
}

TEST(TickMonitor, ClockMayWrap) {
  TickMonitor monitor;
  monitor.isLate(0xFFFFFF00);
  EXPECT_FALSE(monitor.isLate(0xFFFFFF00 + 1000));
}

}  // namespace
}  // namespace vibe_firmware::tick_monitor_test
