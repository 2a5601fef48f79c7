#include "vibe_firmware/core/sample.hpp"

#include <gtest/gtest.h>

namespace vibe_firmware::encoder_test {
namespace {

constexpr std::int64_t kMask[] = {0xFF, 0xFFFF, 0xFFFFFFFF};
constexpr int kBits[] = {8, 16, 32};

/// Drives an encoder whose hardware counter starts at `start`.
class Driver {
 public:
  Driver(int bits, std::int64_t mask, std::int64_t start) : bits_(bits), mask_(mask), position_(start) { move(0); }

  std::int32_t move(std::int64_t counts) {
    position_ += counts;
    return step(config, bits_, {static_cast<std::uint32_t>(position_ & mask_), false, 0}, state);
  }

  /// Moves past an index pulse that comes `before` counts before the end of the motion.
  std::int32_t moveOverIndex(std::int64_t counts, std::int64_t before) {
    position_ += counts;
    const auto at = static_cast<std::uint32_t>((position_ - before) & mask_);
    return step(config, bits_, {static_cast<std::uint32_t>(position_ & mask_), true, at}, state);
  }

  AxisConfig config{};
  EncoderState state{};

 private:
  int bits_;
  std::int64_t mask_, position_;
};

TEST(Encoder, CountsThroughManyWrapsInBothDirections) {
  for (int i = 0; i < 3; ++i) {
    Driver driver(kBits[i], kMask[i], 77);
    std::int32_t expected = 0;
    for (int k = 0; k < 5000; ++k) {
      EXPECT_EQ(driver.move(101), 101);
      expected += 101;
    }
    ASSERT_EQ(driver.state.count, expected) << kBits[i] << " bits";
    for (int k = 0; k < 9000; ++k) driver.move(-113);
    ASSERT_EQ(driver.state.count, expected - 9000 * 113) << kBits[i] << " bits";
    EXPECT_FALSE(driver.state.fault);
  }
}

TEST(Encoder, StartsAtZeroWhateverTheCounterIs) {
  Driver driver(16, 0xFFFF, 54321);
  EXPECT_EQ(driver.state.count, 0);
  EXPECT_FALSE(driver.state.fault);
}

TEST(Encoder, FasterThanPossibleIsAFaultThatStays) {
  Driver driver(16, 0xFFFF, 0);
  const auto possible = static_cast<std::int64_t>(driver.config.speed_limit * 1e-3F / driver.config.radians_per_count);
  driver.move(possible);
  EXPECT_FALSE(driver.state.fault);
  driver.move(possible + 1);
  EXPECT_TRUE(driver.state.fault);
  EXPECT_EQ(driver.state.count, possible);
  driver.move(1);
  EXPECT_TRUE(driver.state.fault);
}

TEST(Encoder, BeyondTheRangeOfAFloatIsAFault) {
  Driver driver(32, 0xFFFFFFFF, 0);
  while (driver.state.count <= kMaxCount) driver.move(300);
  EXPECT_FALSE(driver.state.fault);
  driver.move(0);
  EXPECT_TRUE(driver.state.fault);
}

TEST(Encoder, IndexPulseRestoresLostCounts) {
  Driver driver(16, 0xFFFF, 60000);
  driver.config.counts_per_turn = 1000;
  driver.moveOverIndex(150, 20);  // index at count 130
  EXPECT_TRUE(driver.state.indexed);
  EXPECT_EQ(driver.state.count, 150);
  for (int k = 0; k < 9; ++k) driver.move(100);  // count 1050, but 7 counts were lost: the shaft is at 1057
  EXPECT_EQ(driver.moveOverIndex(90, 17), 90);   // the index comes at count 1123 instead of 1130
  EXPECT_EQ(driver.state.count, 1147);
  EXPECT_FALSE(driver.state.fault);
}

TEST(Encoder, WidthOfTheIndexPulseIsNotCorrected) {
  Driver driver(16, 0xFFFF, 0);
  driver.config.counts_per_turn = 1000;
  driver.moveOverIndex(50, 0);
  for (int k = 0; k < 10; ++k) driver.move(-99);
  driver.moveOverIndex(-11, 0);  // count -951: one count beside -950
  EXPECT_EQ(driver.state.count, -951);
}

TEST(Encoder, IndexFarFromWhereItShouldBeIsAFault) {
  Driver driver(16, 0xFFFF, 0);
  driver.config.counts_per_turn = 1000;
  driver.moveOverIndex(50, 0);
  driver.moveOverIndex(200, 0);
  EXPECT_TRUE(driver.state.fault);
}

}  // namespace
}  // namespace vibe_firmware::encoder_test
