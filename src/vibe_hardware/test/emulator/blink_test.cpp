// The hand that blinks, and the table of its blinks.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "vibe_core/program/error.hpp"
#include "vibe_hardware/emulator/hand.hpp"

namespace vibe::hardware::blink_test {
namespace {

BlinkSetup setupOf(int count, std::uint64_t seed = 1) {
  BlinkSetup setup;
  setup.count = count;
  setup.seed = seed;
  return setup;
}

double wheelAt(const Hand& hand, double time) {
  return hand.at(time).joints[TipLeftRight];
}

std::string contentOf(const std::string& file) {
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

TEST(BlinkHand, JumpsUpAndDownAtItsTimes) {
  const BlinkHand hand(setupOf(7), nullptr);
  ASSERT_EQ(hand.blinks().size(), 7u);
  EXPECT_GE(hand.blinks().front(), 3.25);
  for (std::size_t i = 0; i < 7; ++i) {
    const double low = i % 2 == 0 ? 0 : 0.03;
    EXPECT_EQ(wheelAt(hand, hand.blinks()[i] - 1e-9), low);
    EXPECT_EQ(wheelAt(hand, hand.blinks()[i]), 0.03 - low);
  }
  EXPECT_EQ(hand.duration(), hand.blinks().back() + 1);
}

TEST(BlinkHand, BlinksAfterTheOtherHandAndMovesAsIt) {
  const auto script = std::make_shared<ScriptedHand>(
      TraineeScript::parse("name: t\nactions:\n  - {move: {insertion: 0.1, tip_left_right: 0.2}, in: 2}\n", "t"));
  const BlinkHand hand(setupOf(2), script);
  EXPECT_GE(hand.blinks().front(), script->duration() + 3);
  for (double t = 0; t < 5; t += 0.01) ASSERT_EQ(hand.at(t).joints, script->at(t).joints);
  EXPECT_EQ(hand.at(hand.blinks()[0]).joints[Insertion], 0.1);
  EXPECT_NEAR(wheelAt(hand, hand.blinks()[0]), 0.23, 1e-12);
}

// Against a clock of any period, no phase is preferred (chi squared with 9 degrees of freedom, 0.1 %).
TEST(BlinkHand, HasAUniformPhaseAgainstEveryClock) {
  const BlinkHand hand(setupOf(2000), nullptr);
  for (const double period : {0.001, 0.01, 1.0 / 60, 1.0 / 30, 0.1}) {
    std::array<int, 10> counts{};
    for (const double blink : hand.blinks()) ++counts[static_cast<std::size_t>(10 * std::fmod(blink / period, 1.0))];
    double chi = 0;
    for (const int count : counts) chi += (count - 200.0) * (count - 200.0) / 200;
    EXPECT_LT(chi, 27.9) << period;
  }
}

TEST(BlinkHand, AnotherSeedGivesOtherTimes) {
  EXPECT_EQ(BlinkHand(setupOf(5, 3), nullptr).blinks(), BlinkHand(setupOf(5, 3), nullptr).blinks());
  EXPECT_NE(BlinkHand(setupOf(5, 3), nullptr).blinks(), BlinkHand(setupOf(5, 4), nullptr).blinks());
}

TEST(BlinkHand, NeedsAnEndToBlinkAfterAndAtLeastOneBlink) {
  EXPECT_THROW(BlinkHand(setupOf(5), std::make_shared<RandomHand>(1)), Error);
  EXPECT_THROW(BlinkHand(setupOf(0), nullptr), Error);
}

TEST(BlinkLog, HasTheTimeOfTheBlinkAndOfTheNextReport) {
  const std::string file = ::testing::TempDir() + "blinks.csv";
  BlinkLog log(file, {0.5004, 0.7});
  log.report(100);
  log.tick(0.500, 1'000'000'000);
  log.tick(0.501, 1'001'000'000);
  log.report(1'003'000'000);
  log.report(1'013'000'000);
  log.tick(0.700, 1'200'000'000);
  log.report(1'203'000'000);
  EXPECT_EQ(contentOf(file), "blink,event,report\n0,1000400000,1003000000\n1,1200000000,1203000000\n");
}

TEST(BlinkLog, AFileThatCannotBeWrittenIsSaid) {
  EXPECT_THROW(BlinkLog("/nowhere/blinks.csv", {1}), Error);
}

}  // namespace
}  // namespace vibe::hardware::blink_test
