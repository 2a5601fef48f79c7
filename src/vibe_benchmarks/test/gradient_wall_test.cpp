#include "method/gradient_wall.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <sstream>

namespace vibe::benchmarks::gradient_wall_test {
namespace {

constexpr int kNodes = 800;
constexpr double kTolerance = 1e-6;  // [m]

/// The inflated wall and the response of the shell when the disc is pulled.
struct PulledWall {
  BenchWall wall = makeWall(kNodes);
  BodyMotion start = inflate(wall, kTolerance);
  double error(double distance, const PatchChoice& choice) const {
    double force = 0;
    const BodyMotion equilibrium = pulledEquilibrium(wall, start, distance, kTolerance, force);
    Pull pull;
    pull.distance = distance;
    pull.hold = 0;
    const Trajectory trajectory = runGradient(wall, start, pull, choice);
    return driftApart(trajectory.frames.back(), start, equilibrium, start) / distanceBetween(equilibrium, start);
  }
};

const PulledWall& pulledWall() {
  static const PulledWall wall;
  return wall;
}

TEST(GradientWall, wholeWallIsNearTheShell) {
  // not a bound of the method: the value measured on this wall plus a third
  for (const double distance : {0.005, 0.010}) {
    EXPECT_LT(pulledWall().error(distance, {"", kWholeWall, 0}), 0.26) << distance;
    EXPECT_LT(pulledWall().error(distance, {"", kWholeWall, 1}), 0.20) << distance;
  }
}

TEST(GradientWall, aPatchMissesThatTheOrganGoesAlong) {
  const double large = pulledWall().error(0.010, {"", 0.08, 1}), small = pulledWall().error(0.010, {"", 0.03, 1});
  EXPECT_LT(large, small);
  EXPECT_GT(large, 0.5);
  EXPECT_LT(small, 1) << "better than a wall that stays";
}

TEST(GradientWall, movesTheDiscAndNothingThatIsHeld) {
  const PulledWall& body = pulledWall();
  const Trajectory trajectory = runGradient(body.wall, body.start, Pull{}, {"", kWholeWall, 1});
  ASSERT_EQ(trajectory.frames.size(), 61u);
  EXPECT_EQ(trajectory.times.size(), 60u);
  EXPECT_TRUE(trajectory.force.empty());
  const BodyMotion& last = trajectory.frames.back();
  for (int node = 0; node < kNodes; ++node) {
    Eigen::Vector3d moved;
    for (int axis = 0; axis < 3; ++axis) moved[axis] = last.x[axis][node] - body.start.x[axis][node];
    if (body.wall.body.fixed[node] != 0) {
      EXPECT_EQ(moved.norm(), 0) << node;
    }
  }
  for (const int node : body.wall.tool) {
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(last.x[axis][node] - body.start.x[axis][node], 0.02 * body.wall.pull_direction[axis], 1e-15);
  }
}

TEST(GradientWall, pokesInABedHaveARowPerSetting) {
  std::ostringstream log;
  const auto rows = runPokes(300, log);
  ASSERT_EQ(rows.size(), 2 * (1 + std::size(kPatchChoices)));
  EXPECT_EQ(rows.front().bench_case, "poke_5mm_bed");
  EXPECT_EQ(rows.back().bench_case, "poke_10mm_bed");
  for (const ResultRow& row : rows) {
    EXPECT_GT(row.ms_p50, 0);
    EXPECT_TRUE(std::isfinite(row.static_error)) << row.setting;
    if (row.setting == kPatchChoices[0].name) {
      EXPECT_LT(row.static_error, 1);
    }
    EXPECT_EQ(row.static_error > 0, row.method == "gradient_domain");
  }
}

}  // namespace
}  // namespace vibe::benchmarks::gradient_wall_test
