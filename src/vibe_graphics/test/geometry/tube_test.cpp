#include "vibe_graphics/geometry/tube.hpp"

#include <gtest/gtest.h>

#include <random>

#include "shape_measures.hpp"

namespace vibe::graphics::tube_test {
namespace {

using Eigen::Vector3d;
using Line = std::vector<Vector3d>;

constexpr double kPi = 3.14159265358979323846;
constexpr double kRadius = 0.16e-3;
constexpr double kRounding = 3e-8;  // of single precision at 0.25 m [m]

ColouredShape tubeOf(const Line& line, double radius = kRadius, int sides = 12) {
  ColouredShape shape;
  appendTube(line, radius, packed(1, 1, 1), sides, shape);
  return shape;
}

double lengthOf(const Line& line) {
  double length = 0;
  for (std::size_t k = 1; k < line.size(); ++k) length += (line[k] - line[k - 1]).norm();
  return length;
}

Line helix(int points) {
  Line line;
  for (int k = 0; k < points; ++k) {
    const double t = 0.15 * k;
    line.emplace_back(0.01 * std::cos(t), 0.01 * std::sin(t), 0.002 * t);
  }
  return line;
}

/// Corners from 0 to 180 degrees, points that coincide, and steps far smaller than the radius.
Line nasty() {
  return {{0, 0, 0},       {0.01, 0, 0},    {0.01, 0, 0},       {0.01, 0.01, 0},    {0.01, 0.002, 0.0},
          {0.01, 0.01, 0}, {0.02, 0.02, 0}, {0.02, 0.02, 1e-8}, {0.02, 0.03, 0.01}, {0.011, 0.01, 0.02}};
}

Line randomLine(int seed) {
  std::mt19937 random(static_cast<unsigned>(seed));
  std::uniform_real_distribution<double> place(-0.02, 0.02);
  Line line;
  for (int k = 0; k < 12; ++k) line.emplace_back(place(random), place(random), place(random));
  return line;
}

double farthestOff(const ColouredShape& shape, const Line& line, double radius) {
  double worst = 0;
  for (std::size_t v = 0; v < shape.vertices.size(); ++v) {
    const double distance = distanceToLine(placeOf(shape, v), line);
    // inside of a corner a vertex may be nearer to the other side: never farther out than the radius, ever
    worst = std::max(worst, distance - radius);
  }
  return worst;
}

TEST(Tube, EveryVertexOfASmoothTubeLiesOnTheRadius) {
  const Line line = helix(80);
  const ColouredShape shape = tubeOf(line);
  ASSERT_TRUE(isSound(shape));
  for (std::size_t v = 0; v < shape.vertices.size(); ++v)
    ASSERT_NEAR(distanceToLine(placeOf(shape, v), line), kRadius, 0.003 * kRadius + kRounding) << "vertex " << v;
}

TEST(Tube, NoVertexSticksOutAtSharpCorners) {
  EXPECT_LT(farthestOff(tubeOf(nasty()), nasty(), kRadius), 0.016 * kRadius + kRounding);  // 1 / cos(10 degrees)
  for (int seed = 0; seed < 20; ++seed) {
    const Line line = randomLine(seed);
    EXPECT_LT(farthestOff(tubeOf(line), line, kRadius), 0.016 * kRadius + kRounding) << "seed " << seed;
  }
  EXPECT_GT(farthestOff(tubeOf(nasty(), 1.05 * kRadius), nasty(), kRadius), 0.04 * kRadius);  // control
}

/// A cross-section through the middle of every piece is a circle of the radius: nothing is pinched.
TEST(Tube, PiecesKeepTheirRadiusBetweenSharpCorners) {
  const Line line = nasty();
  const ColouredShape shape = tubeOf(line, kRadius, 16);
  const double inside = kRadius * std::cos(kPi / 16);
  for (std::size_t k = 1; k < line.size(); ++k) {
    const Vector3d way = line[k] - line[k - 1];
    if (way.norm() < kRadius) continue;
    const Vector3d along = way.normalized(), middle = line[k - 1] + 0.5 * way;
    int cuts = 0;
    for (std::size_t t = 0; t < shape.triangles.size(); t += 3)
      for (std::size_t e = 0; e < 3; ++e) {
        const Vector3d a = placeOf(shape, shape.triangles[t + e]), b = placeOf(shape, shape.triangles[t + (e + 1) % 3]);
        const double from = (a - middle).dot(along), to = (b - middle).dot(along);
        if (!(from < 0 && to >= 0)) continue;
        const Vector3d cut = a + from / (from - to) * (b - a);
        const double distance = (cut - middle).norm();
        if (distance > 3 * kRadius) continue;  // another piece
        ++cuts;
        EXPECT_GT(distance, inside - kRounding) << "piece " << k;
        EXPECT_LT(distance, kRadius + kRounding) << "piece " << k;
      }
    EXPECT_GE(cuts, 16) << "piece " << k;
  }
}

TEST(Tube, IsClosedAndFacesOutwards) {
  for (const Line& line : {helix(30), nasty(), randomLine(1), Line{{0, 0, 0}}, Line{{0, 0, 0}, {0.1, 0, 0}}}) {
    ColouredShape shape = tubeOf(line);
    EXPECT_TRUE(isClosed(shape));
    EXPECT_GT(volumeOf(shape), 0);
    shape.triangles.resize(shape.triangles.size() - 3);
    EXPECT_FALSE(isClosed(shape));  // control: a missing triangle is seen
  }
}

TEST(Tube, NormalsPointAwayFromTheCentreLine) {
  const Line line = helix(60);
  const ColouredShape shape = tubeOf(line);
  for (std::size_t v = 0; v < shape.vertices.size(); ++v) {
    const Vector3d p = placeOf(shape, v), outside = p + 0.5 * kRadius * normalOf(shape, v);
    EXPECT_NEAR(distanceToLine(outside, line), 1.5 * kRadius, 0.01 * kRadius + kRounding);
  }
}

/// A prism over a regular polygon, and balls at the ends; what a mitred corner takes away inside it adds outside, and
/// what a disc sweeps that turns about its own diameter cancels.
TEST(Tube, EnclosesTheVolumeOfItsLength) {
  for (const int sides : {8, 12, 32}) {
    const double area = 0.5 * sides * std::sin(2 * kPi / sides) * kRadius * kRadius;
    const double ball = 4.0 / 3 * kPi * std::pow(kRadius, 3);
    for (const Line& line : {helix(60), nasty(), randomLine(3), randomLine(4)}) {
      const double volume = volumeOf(tubeOf(line, kRadius, sides)), expected = area * lengthOf(line);
      EXPECT_GT(volume, expected - 0.02 * ball);
      EXPECT_LT(volume, expected + 1.5 * ball);
      EXPECT_NEAR(volume, kPi * kRadius * kRadius * lengthOf(line), (7.0 / (sides * sides)) * volume + 1.5 * ball);
    }
  }
}

TEST(Tube, BallHasItsRadiusAndVolume) {
  ColouredShape shape;
  appendBall({0.1, -0.2, 0.05}, 0.004, packed(1, 0, 0), 40, shape);
  for (std::size_t v = 0; v < shape.vertices.size(); ++v)
    EXPECT_NEAR((placeOf(shape, v) - Vector3d(0.1, -0.2, 0.05)).norm(), 0.004, kRounding);
  EXPECT_NEAR(volumeOf(shape) / (4.0 / 3 * kPi * std::pow(0.004, 3)), 1, 0.02);
}

TEST(Tube, MovesRigidlyWithItsLine) {
  const Eigen::AngleAxisd turn(1.1, Vector3d(0.3, -0.5, 0.8).normalized());
  const Vector3d shift(0.03, -0.02, 0.05);
  for (const Line& line : {helix(40), nasty(), randomLine(7)}) {
    Line moved;
    for (const Vector3d& p : line) moved.emplace_back(turn * p + shift);
    const ColouredShape before = tubeOf(line), after = tubeOf(moved);
    ASSERT_EQ(before.triangles, after.triangles);
    for (std::size_t v = 0; v < before.vertices.size(); ++v)
      EXPECT_LT((turn * placeOf(before, v) + shift - placeOf(after, v)).norm(), 2 * kRounding);
  }
}

/// Parallel transport: along a plane curve one direction of the rings stays at right angles to the plane.
TEST(Tube, RingsDoNotTwist) {
  Line line;
  for (int k = 0; k < 50; ++k) line.emplace_back(0.01 * std::cos(0.1 * k), 0.01 * std::sin(0.1 * k), 0);
  const int sides = 12;
  const ColouredShape shape = tubeOf(line, kRadius, sides);
  const std::size_t first = 1 + 2 * sides;  // behind the pole and two circles of the end
  for (std::size_t ring = 0; ring < line.size(); ++ring)
    EXPECT_NEAR(std::abs(placeOf(shape, first + ring * sides).z()), kRadius, kRounding) << "ring " << ring;
}

TEST(Tube, TakesItsColoursAndRadiiFromThePoints) {
  ColouredShape shape;
  appendTube({{{0, 0, 0}, 0.001, packed(1, 0, 0)}, {{0.05, 0, 0}, 0.003, packed(0, 0, 1)}}, 12, shape);
  for (std::size_t v = 0; v < shape.vertices.size(); ++v) {
    const bool begin = placeOf(shape, v).x() < 0.02;
    EXPECT_EQ(shape.colours[v], begin ? packed(1, 0, 0) : packed(0, 0, 1));
    EXPECT_NEAR((placeOf(shape, v) - Vector3d(begin ? 0 : 0.05, 0, 0)).norm(), begin ? 0.001 : 0.003, kRounding);
  }
}

TEST(Tube, IsAppendedToTheShape) {
  ColouredShape shape;
  appendTube({{0, 0, 0}, {0.1, 0, 0}}, 0.001, packed(1, 1, 1), 8, shape);
  const std::size_t vertices = shape.vertices.size(), triangles = shape.triangles.size();
  appendTube({{0, 1, 0}, {0.1, 1, 0}}, 0.001, packed(1, 1, 1), 8, shape);
  ASSERT_EQ(shape.triangles.size(), 2 * triangles);
  for (std::size_t t = 0; t < triangles; ++t) EXPECT_EQ(shape.triangles[triangles + t], shape.triangles[t] + vertices);
}

TEST(Tube, WithoutPointsNothingIsDrawn) {
  EXPECT_TRUE(tubeOf({}).vertices.empty());
}

TEST(Tube, AnyNormalIsPerpendicular) {
  for (const Vector3d& v : {Vector3d(1, 0, 0), Vector3d(0, 1, 0), Vector3d(0, 0, -1), Vector3d(1, 2, 3).normalized()}) {
    EXPECT_NEAR(anyNormal(v).dot(v), 0, 1e-12);
    EXPECT_NEAR(anyNormal(v).norm(), 1, 1e-12);
  }
}

}  // namespace
}  // namespace vibe::graphics::tube_test
