// Which stamps of inputs are accepted.
#include "input/input_sample.hpp"

#include <gtest/gtest.h>

namespace vibe::sim::input_window_test {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000, kHour = 3600 * kSecond, kNow = 1'700'000'000 * kSecond;

TEST(InputWindow, AcceptsWhatIsCloseAndStampsThatAreLeftOut) {
  const InputWindow window{kSecond / 2, kSecond};
  for (const std::int64_t off : {-kSecond, std::int64_t{0}, kSecond / 2})
    EXPECT_EQ(faultOf(kNow + off, kNow, window), "") << off;
  EXPECT_EQ(faultOf(0, kNow, window), "");
}

TEST(InputWindow, SaysHowFarOffAStampIs) {
  const InputWindow window{kSecond / 2, kSecond};
  EXPECT_EQ(faultOf(kNow + kHour, kNow, window),
            "its stamp is 3600.0 s ahead of the simulator's time, and 0.5 s are accepted");
  EXPECT_NE(faultOf(kNow - kHour, kNow, window).find("behind the simulator's time, and 1 s"), std::string::npos);
  EXPECT_NE(faultOf(kNow + kSecond / 2 + 1, kNow, window), "");
  EXPECT_NE(faultOf(kNow - kSecond - 1, kNow, window), "");
}

TEST(InputWindow, InSimulatedTimeOldStampsCountAndWallClocksDoNot) {
  const InputWindow window = InputWindow::ofSimulatedTime();
  EXPECT_EQ(faultOf(1, 1000 * kSecond, window), "");
  EXPECT_EQ(faultOf(1030 * kSecond, 1000 * kSecond, window), "");
  EXPECT_NE(faultOf(kNow, 1000 * kSecond, window), "");
}

}  // namespace
}  // namespace vibe::sim::input_window_test
