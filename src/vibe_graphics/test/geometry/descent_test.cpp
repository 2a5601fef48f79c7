#include "vibe_graphics/geometry/basins.hpp"

#include <gtest/gtest.h>

#include "walls.hpp"

namespace vibe::graphics::descent_test {
namespace {

using Eigen::Vector3d;

const Vector3d kDown = -Vector3d::UnitZ();

/// Largest angle of a step to a direction [rad].
double worstAngle(const std::vector<WallPlace>& line, const Vector3d& direction) {
  double worst = 0;
  for (std::size_t k = 1; k < line.size(); ++k) {
    const Vector3d step = line[k].place - line[k - 1].place;
    worst = std::max(worst, std::atan2(step.cross(direction).norm(), step.dot(direction)));
  }
  return worst;
}

TEST(Descent, FollowsTheLineOfSteepestDescentOfAPlane) {
  const double a = 0.5, b = -0.3;  // z = a x + b y
  const test::HeightWall plane(41, 0.04, [&](double x, double y) { return a * x + b * y; });
  const WallSurface wall = plane.surface();
  const auto start = wall.nearest({0.02, -0.01, 0.5 * 0.02 + 0.3 * 0.01}, Vector3d::UnitZ(), 0.01);
  ASSERT_TRUE(start);
  const std::vector<WallPlace> line = steepestDescent(wall, *start, kDown);
  const Vector3d steepest = Vector3d(-a, -b, -(a * a + b * b)).normalized();
  ASSERT_GT(line.size(), 20U);
  // until the edge of the wall, along which it would go on
  std::vector<WallPlace> inside;
  for (const WallPlace& point : line)
    if (point.place.head<2>().cwiseAbs().maxCoeff() < 0.0385) inside.push_back(point);
  std::printf("largest angle to the steepest descent %.2g rad over %zu steps\n", worstAngle(inside, steepest),
              inside.size() - 1);
  EXPECT_GT(inside.size(), 20U);
  EXPECT_LT(worstAngle(inside, steepest), 1e-4);
  EXPECT_GT(worstAngle(inside, kDown), 0.5);  // control
}

TEST(Descent, EndsAtTheBottomOfABowlWithinATriangle) {
  const test::HeightWall form(61, 0.036, test::bowl);
  const WallSurface wall = form.surface();
  const double triangle = 0.072 / 60;  // [m]
  for (const Vector3d& place : {Vector3d(0.02, 0.005, 0.006), Vector3d(-0.015, 0.021, 0.009), Vector3d(0.004, 0, 0)}) {
    const auto start = wall.nearest(place, Vector3d::UnitZ(), 0.01);
    ASSERT_TRUE(start);
    const std::vector<WallPlace> line = steepestDescent(wall, *start, kDown);
    EXPECT_LT(line.back().place.norm(), triangle);
    for (std::size_t k = 1; k < line.size(); ++k) EXPECT_LT(line[k].place.z(), line[k - 1].place.z());
    const std::uint32_t bottom = bottomBelow(wall, line.back(), kDown);
    EXPECT_LT(wall.places()[bottom].norm(), 1e-9);
    EXPECT_GT(start->place.norm(), 2 * triangle);  // control: it did not begin there
  }
}

TEST(Descent, NothingRunsOnALevelWall) {
  const test::HeightWall level(11, 0.02, [](double, double) { return 0.01; });
  const WallSurface wall = level.surface();
  const auto start = wall.nearest({0.001, 0.002, 0.01}, Vector3d::UnitZ(), 0.01);
  ASSERT_TRUE(start);
  EXPECT_EQ(steepestDescent(wall, *start, kDown).size(), 1U);
  EXPECT_FALSE(wall.nearest({0.001, 0.002, 0.01}, -Vector3d::UnitZ(), 0.01));  // a wall that faces the other way
  EXPECT_FALSE(wall.nearest({0.001, 0.002, 0.03}, Vector3d::UnitZ(), 0.01));   // and one that is far
}

TEST(Descent, LineLandsOnTheWallFromTheLumenOnly) {
  const test::HeightWall form(61, 0.036, test::bowl);
  const WallSurface wall = form.surface();
  double along = 0;
  const auto landing = wall.landing({{0.01, 0, 0.05}, {0.01, 0, 0.03}, {0.01, 0, -0.01}}, along);
  ASSERT_TRUE(landing);
  EXPECT_NEAR(landing->place.z(), test::bowl(0.01, 0), 1e-5);
  EXPECT_NEAR(along, 1 + (0.03 - landing->place.z()) / 0.04, 1e-6);
  EXPECT_FALSE(wall.landing({{0.01, 0, -0.01}, {0.01, 0, 0.05}}, along));
}

TEST(Descent, TrianglesWithoutAreaDoNoHarm) {
  test::HeightWall form(61, 0.036, test::bowl);
  form.triangles.insert(form.triangles.end(), {10, 10, 11, 1830, 1830, 1830, 1860, 1861, 1860});
  const WallSurface wall = form.surface();
  const auto start = wall.nearest({0.02, 0.005, 0.006}, Vector3d::UnitZ(), 0.01);
  ASSERT_TRUE(start);
  for (const WallPlace& point : steepestDescent(wall, *start, kDown)) {
    EXPECT_TRUE(point.place.allFinite());
    EXPECT_NEAR(point.inward.norm(), 1, 1e-9);
  }
}

}  // namespace
}  // namespace vibe::graphics::descent_test
