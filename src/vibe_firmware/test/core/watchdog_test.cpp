#include "vibe_firmware/core/haptic_device.hpp"

#include <gtest/gtest.h>

namespace vibe_firmware::watchdog_test {
namespace {

TEST(Watchdog, FadesTickByTick) {
  constexpr Watchdog watchdog{200, 50};
  std::uint32_t ticks = 0;
  for (std::uint32_t i = 1; i <= 300; ++i) {
    ticks = watchdog.next(ticks);
    EXPECT_EQ(ticks, i < 250 ? i : 250);
    EXPECT_EQ(watchdog.silent(ticks), i >= 200);
    const float expected = i <= 200 ? 1.0F : i >= 250 ? 0.0F : static_cast<float>(250 - i) / 50.0F;
    EXPECT_EQ(watchdog.springGain(ticks), expected) << "tick " << i;
  }
}

TEST(Watchdog, RampMayBeASingleTickOrNone) {
  constexpr Watchdog single{3, 1};
  EXPECT_EQ(single.springGain(3), 1);
  EXPECT_EQ(single.springGain(4), 0);
  constexpr Watchdog none{3, 0};
  EXPECT_EQ(none.springGain(2), 1);
  EXPECT_EQ(none.springGain(3), 0);
}

TEST(Watchdog, DeviceStartsSilent) {
  constexpr Watchdog watchdog{200, 50};
  EXPECT_TRUE(watchdog.silent(watchdog.end()));
  EXPECT_EQ(watchdog.springGain(watchdog.end()), 0);
}

}  // namespace
}  // namespace vibe_firmware::watchdog_test
