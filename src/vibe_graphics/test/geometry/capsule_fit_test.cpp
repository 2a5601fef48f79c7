#include "vibe_graphics/geometry/capsule_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "vibe_graphics/geometry/tube.hpp"

namespace vibe::graphics::capsule_fit_test {
namespace {

using Eigen::Vector3d;

std::vector<Capsule> capsulesOf(const ColouredShape& shape) {
  std::vector<Eigen::Vector3f> points;
  for (const MovingVertex& v : shape.vertices) points.push_back(Eigen::Map<const Eigen::Vector3f>(v.position));
  return fitCapsules(points, shape.triangles);
}

double distanceTo(const Capsule& capsule, const Vector3d& p) {
  const Vector3d along = capsule.to - capsule.from;
  const double t = std::clamp(along.dot(p - capsule.from) / std::max(along.squaredNorm(), 1e-18), 0.0, 1.0);
  return (p - capsule.from - t * along).norm();
}

TEST(CapsuleFit, RodIsOneCapsuleWithItsAxisAndRadius) {
  const Vector3d from(0.001, 0.002, -0.003), to(0.011, -0.004, 0.013);
  ColouredShape shape;
  appendTube({from, 0.5 * (from + to), to}, 0.001, 0xffffffffU, 24, shape);
  const std::vector<Capsule> capsules = capsulesOf(shape);
  ASSERT_EQ(capsules.size(), 1u);
  EXPECT_NEAR(capsules[0].radius, 0.001, 0.0001);
  const bool turned = (capsules[0].from - from).norm() > (capsules[0].to - from).norm();
  EXPECT_LT(((turned ? capsules[0].to : capsules[0].from) - from).norm(), 0.0015);
  EXPECT_LT(((turned ? capsules[0].from : capsules[0].to) - to).norm(), 0.0015);
}

TEST(CapsuleFit, BentRodIsFollowed) {
  // a quarter of a circle of 20 mm
  std::vector<Vector3d> line;
  for (int k = 0; k <= 24; ++k) {
    const double angle = 1.5707963 * k / 24;
    line.push_back(0.02 * Vector3d(std::cos(angle), std::sin(angle), 0));
  }
  ColouredShape shape;
  appendTube(line, 0.0005, 0xffffffffU, 12, shape);
  const std::vector<Capsule> capsules = capsulesOf(shape);
  EXPECT_GE(capsules.size(), 4u);
  for (const Vector3d& p : line) {
    double nearest = 1;
    for (const Capsule& capsule : capsules) nearest = std::min(nearest, distanceTo(capsule, p) - capsule.radius);
    EXPECT_LT(nearest, 0.0004);
  }
  for (const Capsule& capsule : capsules) EXPECT_LT(capsule.radius, 0.001);  // one for all would have 2.6 mm
}

TEST(CapsuleFit, PartsAreSeparate) {
  ColouredShape shape;
  appendBall({0, 0, 0}, 0.001, 0xffffffffU, 12, shape);
  appendBall({0.05, 0, 0}, 0.002, 0xffffffffU, 12, shape);
  const std::vector<Capsule> capsules = capsulesOf(shape);
  ASSERT_EQ(capsules.size(), 2u);
  for (const Capsule& capsule : capsules) EXPECT_LT((capsule.to - capsule.from).norm(), 0.004);
}

TEST(CapsuleFit, NothingOfNothing) {
  EXPECT_TRUE(fitCapsules({}, {}).empty());
  EXPECT_TRUE(fitCapsules({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2}).empty());
  const std::vector<Eigen::Vector3f> same(8, Eigen::Vector3f::Ones());
  for (const Capsule& capsule : fitCapsules(same, {0, 1, 2, 3, 4, 5})) EXPECT_TRUE(capsule.from.allFinite());
}

}  // namespace
}  // namespace vibe::graphics::capsule_fit_test
