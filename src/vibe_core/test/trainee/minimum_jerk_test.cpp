#include "trainee/operator.hpp"

#include <gtest/gtest.h>

namespace vibe::minimum_jerk_test {
namespace {

constexpr double kStep = 1e-4;

double speed(double s) {
  return (minimumJerk(s + kStep) - minimumJerk(s - kStep)) / (2 * kStep);
}
double acceleration(double s) {
  return (minimumJerk(s + kStep) - 2 * minimumJerk(s) + minimumJerk(s - kStep)) / (kStep * kStep);
}

TEST(MinimumJerk, GoesFromZeroToOne) {
  EXPECT_EQ(minimumJerk(0), 0);
  EXPECT_EQ(minimumJerk(1), 1);
  EXPECT_EQ(minimumJerk(-3), 0);
  EXPECT_EQ(minimumJerk(7), 1);
  EXPECT_DOUBLE_EQ(minimumJerk(0.5), 0.5);
}

TEST(MinimumJerk, IsThePolynomial) {
  for (double s = 0; s <= 1; s += 0.01) {
    EXPECT_NEAR(minimumJerk(s), 10 * s * s * s - 15 * s * s * s * s + 6 * s * s * s * s * s, 1e-14) << s;
    EXPECT_NEAR(minimumJerk(s) + minimumJerk(1 - s), 1, 1e-14) << s;  // symmetric about the middle
  }
}

TEST(MinimumJerk, RestsAtBothEnds) {
  EXPECT_NEAR(speed(0), 0, 1e-6);
  EXPECT_NEAR(speed(1), 0, 1e-6);
  EXPECT_NEAR(acceleration(0), 0, 60 * kStep);  // the second derivative grows by 60 per share of time
  EXPECT_NEAR(acceleration(1), 0, 60 * kStep);
  EXPECT_NEAR(acceleration(0.25), 60 * 0.25 - 180 * 0.0625 + 120 * 0.015625, 1e-3);
}

TEST(MinimumJerk, PeakSpeedIsFifteenEighthsOfTheMean) {
  EXPECT_NEAR(speed(0.5), 1.875, 1e-6);
  for (double s = kStep; s < 1; s += 0.01) EXPECT_LE(speed(s), 1.875 + 1e-9) << s;
}

}  // namespace
}  // namespace vibe::minimum_jerk_test
