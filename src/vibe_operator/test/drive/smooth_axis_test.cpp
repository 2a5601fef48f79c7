#include "vibe_operator/drive/scope_drive.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace vibe::operating::smooth_axis_test {
namespace {

const AxisLimits kInsertion = {0, 0.3, 0.15, 0.5};

/// A goal and a speed that hold for some time.
struct Command {
  double seconds, goal, speed;
};

std::vector<Command> randomCommands(std::mt19937& random, const AxisLimits& limits) {
  std::uniform_real_distribution<double> share(0, 1);
  std::vector<Command> commands(40);
  for (Command& command : commands) {
    command.seconds = 0.7 * share(random);
    command.goal = limits.lower + (limits.upper - limits.lower) * (1.4 * share(random) - 0.2);  // also out of reach
    command.speed = 1.5 * limits.velocity * share(random);
  }
  return commands;
}

TEST(SmoothAxis, MotionFromRestToRestIsTheAnalyticOne) {
  SmoothAxis axis;
  axis.rest(kInsertion, 0.1);
  axis.advance(0.1, 0.2, 0.1);  // reaches 0.05 m/s after 2.5 mm
  EXPECT_NEAR(axis.velocity(), 0.05, 1e-12);
  EXPECT_NEAR(axis.position(), 0.1025, 1e-12);
  axis.advance(0.1, 0.2, 0.1);  // full speed after 0.2 s and 10 mm
  EXPECT_NEAR(axis.position(), 0.11, 1e-12);
  axis.advance(0.8, 0.2, 0.1);  // 80 mm at 0.1 m/s, then 0.2 s to brake
  EXPECT_NEAR(axis.position(), 0.19, 1e-12);
  EXPECT_NEAR(axis.velocity(), 0.1, 1e-9);
  axis.advance(0.2, 0.2, 0.1);
  EXPECT_NEAR(axis.position(), 0.2, 1e-9);
  EXPECT_NEAR(axis.velocity(), 0, 1e-9);
}

TEST(SmoothAxis, ShortMotionHasNoCruise) {
  SmoothAxis axis;
  axis.rest(kInsertion, 0);
  axis.advance(2 * std::sqrt(0.002 / 0.5), 0.002, 0.15);  // half of the way speeding up, half braking
  EXPECT_NEAR(axis.position(), 0.002, 1e-9);
  EXPECT_NEAR(axis.velocity(), 0, 1e-6);
}

TEST(SmoothAxis, VelocityIsBoundedAndHasNoStep) {
  std::mt19937 random(7);
  const double dt = 1e-3;
  for (int run = 0; run < 50; ++run) {
    SmoothAxis axis;
    axis.rest(kInsertion, 0.1);
    for (const Command& command : randomCommands(random, kInsertion))
      for (double t = 0; t < command.seconds; t += dt) {
        const double before = axis.velocity();
        axis.advance(dt, command.goal, command.speed);
        ASSERT_LE(std::abs(axis.velocity() - before), kInsertion.acceleration * dt + 1e-6);
        ASSERT_LE(std::abs(axis.velocity()), kInsertion.velocity + 1e-12);
        ASSERT_GE(axis.position(), kInsertion.lower - 1e-9);
        ASSERT_LE(axis.position(), kInsertion.upper + 1e-9);
      }
  }
}

TEST(SmoothAxis, MotionDoesNotDependOnTheFrameRate) {
  std::mt19937 random(3);
  std::uniform_int_distribution<int> parts(2, 60);
  double moved = 0;
  for (int run = 0; run < 200; ++run) {
    SmoothAxis once, often;
    once.rest(kInsertion, 0.1);
    often.rest(kInsertion, 0.1);
    for (const Command& command : randomCommands(random, kInsertion)) {
      once.advance(command.seconds, command.goal, command.speed);
      const int count = parts(random);
      for (int i = 0; i < count; ++i) often.advance(command.seconds / count, command.goal, command.speed);
      ASSERT_NEAR(once.position(), often.position(), 1e-8);
      moved = std::max(moved, std::abs(once.position() - 0.1));
    }
  }
  EXPECT_GT(moved, 0.1);
}

TEST(SmoothAxis, StopsWhereItSaid) {
  SmoothAxis axis;
  axis.rest(kInsertion, 0.1);
  axis.advance(0.3, 0.3, 0.15);
  const double there = axis.stoppingPoint();
  EXPECT_GT(there, axis.position() + 0.01);
  axis.advance(5, there, 0.15);
  EXPECT_NEAR(axis.position(), there, 1e-9);
  EXPECT_EQ(axis.velocity(), 0);
}

TEST(SmoothAxis, ReachesTheLimitExactly) {
  SmoothAxis axis;
  axis.rest(kInsertion, 0.29);
  axis.advance(10, 1, 1);
  EXPECT_EQ(axis.position(), 0.3);
  axis.rest(kInsertion, 7);
  EXPECT_EQ(axis.position(), 0.3) << "a start out of the limits";
}

TEST(SmoothAxis, ASpeedOfZeroHolds) {
  SmoothAxis axis;
  axis.rest(kInsertion, 0.1);
  axis.advance(0.2, 0.3, 0.15);
  axis.advance(10, 0.3, 0);
  EXPECT_NEAR(axis.velocity(), 0, 1e-12);
  EXPECT_LT(axis.position(), 0.2);
}

}  // namespace
}  // namespace vibe::operating::smooth_axis_test
