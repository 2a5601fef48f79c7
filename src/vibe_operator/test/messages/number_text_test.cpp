#include "vibe_operator/messages/number_text.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace vibe::operating::number_text_test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(NumberText, HasTheRequestedDecimals) {
  EXPECT_EQ(numberText(12.345, 2), "12.35");
  EXPECT_EQ(numberText(12.5, 0), "12");  // ties go to even
  EXPECT_EQ(numberText(-3.25, 1), "-3.2");
  EXPECT_EQ(numberText(7, -1), "7");
}

TEST(NumberText, NoValueIsADash) {
  for (const double nothing : {kNaN, kInfinity, -kInfinity}) {
    EXPECT_EQ(numberText(nothing, 1), "\u2013");
    EXPECT_EQ(quantityText(nothing, 1, "mm"), "\u2013") << "a unit of nothing";
  }
  EXPECT_NE(numberText(0, 1), "\u2013") << "zero is a value";
}

TEST(NumberText, ZeroHasNoSign) {
  EXPECT_EQ(numberText(-0.0, 2), "0.00");
  EXPECT_EQ(numberText(-0.001, 2), "0.00");
  EXPECT_EQ(numberText(-0.006, 2), "-0.01");
}

TEST(NumberText, TextIsShortForAnyNumber) {
  EXPECT_LT(numberText(1e300, 2).size(), 10u);
  EXPECT_EQ(numberText(2e9, 2), "2.0e+09");
  EXPECT_LT(numberText(1e-300, 100).size(), 20u);
}

TEST(NumberText, UnitsAreAppended) {
  EXPECT_EQ(quantityText(3.14159, 1, "N"), "3.1 N");
  EXPECT_EQ(quantityText(3, 0, ""), "3");
  EXPECT_EQ(countText(0, "bite"), "0 bites");
  EXPECT_EQ(countText(1, "bite"), "1 bite");
}

TEST(NumberText, DurationsHaveMinutesAndHours) {
  EXPECT_EQ(durationText(7.46), "7.5 s");
  EXPECT_EQ(durationText(59.96), "1:00");
  EXPECT_EQ(durationText(187), "3:07");
  EXPECT_EQ(durationText(3727), "1:02:07");
  EXPECT_EQ(durationText(kNaN), "\u2013");
  EXPECT_EQ(durationText(-1), "\u2013");
  EXPECT_EQ(durationText(1e300), "\u2013");
}

}  // namespace
}  // namespace vibe::operating::number_text_test
