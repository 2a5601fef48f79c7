#include "vibe_operator/messages/button_bank.hpp"

#include <gtest/gtest.h>

namespace vibe::operating::button_bank_test {
namespace {

using Buttons = std::array<std::int32_t, kCommandCount>;
enum : int { Apc, Helix, Needle, TTag, Cinch, Insufflate };

Moment at(double seconds, bool paused = false, std::uint64_t step = 0) {
  Moment moment;
  moment.wall = moment.stamp = seconds;
  moment.step_period = 1.0 / 60;
  moment.paused = paused;
  moment.step = step;
  return moment;
}

TEST(ButtonBank, ButtonIsDownWhileHeld) {
  ButtonBank bank;
  bank.press(Apc, at(10));
  EXPECT_EQ(bank.down(), (Buttons{1, 0, 0, 0, 0, 0}));
  EXPECT_FALSE(bank.settle(at(20)));
  EXPECT_EQ(bank.down()[Apc], 1) << "nobody let go";
  bank.release(Apc);
  EXPECT_TRUE(bank.settle(at(20)));
  EXPECT_EQ(bank.down(), Buttons{});
}

TEST(ButtonBank, TogglesStayDown) {
  ButtonBank bank;
  bank.press(Helix, at(1));
  bank.release(Helix);
  EXPECT_FALSE(bank.settle(at(100)));
  EXPECT_EQ(bank.down(), (Buttons{0, 1, 0, 0, 0, 0}));
  bank.press(Helix, at(101));
  EXPECT_EQ(bank.down(), Buttons{});
}

TEST(ButtonBank, HelixAndInsufflatorToggle) {
  ButtonBank bank;
  for (int button = 0; button < kCommandCount; ++button) {
    bank.press(button, at(1));
    bank.release(button);
  }
  bank.settle(at(10));
  EXPECT_EQ(bank.down(), (Buttons{0, 1, 0, 0, 0, 1}));
}

TEST(ButtonBank, ShortClickIsSeen) {
  ButtonBank bank;
  bank.press(Needle, at(1));
  bank.release(Needle);
  EXPECT_FALSE(bank.settle(at(1.01)));
  EXPECT_EQ(bank.down()[Needle], 1) << "the simulator may not have taken a step yet";
  EXPECT_TRUE(bank.settle(at(1.2)));
  EXPECT_EQ(bank.down()[Needle], 0);
}

TEST(ButtonBank, ButtonStaysDownWhileSimulatedTimeStandsStill) {
  ButtonBank bank;
  bank.press(TTag, at(1));
  bank.release(TTag);
  Moment late = at(1);
  late.wall = 100;
  EXPECT_FALSE(bank.settle(late));
  late.stamp = 1 + 2.5 / 60;
  EXPECT_TRUE(bank.settle(late));
}

TEST(ButtonBank, TimeSetBackReleasesTheButton) {
  ButtonBank bank;
  bank.press(TTag, at(1000));
  bank.release(TTag);
  Moment back = at(1);
  back.wall = 1001;
  EXPECT_TRUE(bank.settle(back));
}

TEST(ButtonBank, ButtonStaysDownDuringAPause) {
  ButtonBank bank;
  bank.press(Needle, at(1, true, 7));
  bank.release(Needle);
  EXPECT_FALSE(bank.settle(at(50, true, 7)));
  EXPECT_FALSE(bank.settle(at(50.01, false, 7))) << "just resumed: no step yet";
  EXPECT_TRUE(bank.settle(at(50.2, false, 13)));
}

TEST(ButtonBank, SingleStepInAPauseIsEnough) {
  ButtonBank bank;
  bank.press(Needle, at(1, true, 7));
  bank.release(Needle);
  EXPECT_FALSE(bank.settle(at(2, true, 7)));
  EXPECT_TRUE(bank.settle(at(2, true, 8)));
}

TEST(ButtonBank, AdoptsTogglesOnly) {
  ButtonBank bank;
  bank.adopt({1, 1, 1, 1, 1, 1});
  EXPECT_EQ(bank.down(), (Buttons{0, 1, 0, 0, 0, 1}));
  bank.adopt({0, 0, 0});
  EXPECT_EQ(bank.down(), (Buttons{0, 1, 0, 0, 0, 1})) << "a message of the wrong size";
}

TEST(ButtonBank, LiftsHeldButtons) {
  ButtonBank bank;
  bank.press(Apc, at(1));
  bank.press(Cinch, at(1));
  bank.press(Insufflate, at(1));
  bank.liftHeld();
  EXPECT_EQ(bank.down(), (Buttons{0, 0, 0, 0, 0, 1}));
}

TEST(ButtonBank, InvalidButtonHasNoEffect) {
  ButtonBank bank;
  for (const int button : {-1, 6, 1000}) {
    bank.press(button, at(1));
    bank.release(button);
  }
  EXPECT_EQ(bank.down(), Buttons{});
}

}  // namespace
}  // namespace vibe::operating::button_bank_test
