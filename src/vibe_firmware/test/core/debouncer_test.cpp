#include "vibe_firmware/core/sample.hpp"

#include <gtest/gtest.h>

namespace vibe_firmware::debouncer_test {
namespace {

TEST(Debouncer, ChangesInTheTickInWhichTheContactHasBeenStillLongEnough) {
  DebouncerState state;
  for (int i = 1; i <= 4; ++i) {
    step(5, 1, state);
    EXPECT_EQ(state.buttons, 0) << "tick " << i;
  }
  step(5, 1, state);
  EXPECT_EQ(state.buttons, 1);
  for (int i = 1; i <= 4; ++i) step(5, 0, state);
  EXPECT_EQ(state.buttons, 1);
  step(5, 0, state);
  EXPECT_EQ(state.buttons, 0);
}

TEST(Debouncer, BouncingContactStartsAgain) {
  DebouncerState state;
  for (int i = 0; i < 100; ++i) step(5, i % 5 == 4 ? 0 : 1, state);  // four ticks closed, one open
  EXPECT_EQ(state.buttons, 0);
}

TEST(Debouncer, ButtonsAreIndependent) {
  DebouncerState state;
  for (int i = 0; i < 5; ++i)
    step(5, static_cast<std::uint16_t>(0x8000 | (i % 2 == 0 ? 4 : 0) | (i > 2 ? 2 : 0)), state);
  EXPECT_EQ(state.buttons, 0x8000);
  step(5, 0x8002, state);
  step(5, 0x8002, state);
  step(5, 0x8002, state);
  EXPECT_EQ(state.buttons, 0x8002);
}

TEST(Debouncer, OneTickAndNoneFollowAtOnce) {
  for (const int ticks : {0, 1}) {
    DebouncerState state;
    step(static_cast<std::uint8_t>(ticks), 0x1234, state);
    EXPECT_EQ(state.buttons, 0x1234);
  }
}

}  // namespace
}  // namespace vibe_firmware::debouncer_test
