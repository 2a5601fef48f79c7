#include "tool_contact/shape_distance.hpp"

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <random>
#include <vector>

namespace vibe::point_distance_test {
namespace {

using Eigen::Vector3d;

constexpr double kExact = 1e-9;     // a float dimension of the tool's size is rounded by less
constexpr double kGjkError = 1e-5;  // float scalars; 1e-11 with double ones

struct Case {
  Vector3d p;
  double distance;
  Vector3d normal;
};

void check(const btConvexShape& shape, const std::vector<Case>& cases) {
  const PointDistance distance(shape);
  for (const Case& c : cases) {
    Vector3d normal;
    EXPECT_NEAR(distance(c.p, normal), c.distance, kExact) << "at " << c.p.transpose();
    EXPECT_LT((normal - c.normal).norm(), 1e-6) << "at " << c.p.transpose() << ": " << normal.transpose();
  }
}

std::unique_ptr<btBoxShape> makeBox(double x, double y, double z) {
  auto box = std::make_unique<btBoxShape>(
      btVector3(static_cast<btScalar>(x), static_cast<btScalar>(y), static_cast<btScalar>(z)));
  box->setMargin(0);
  return box;
}

std::unique_ptr<btCylinderShapeZ> makeCylinder(double radius, double half_length) {
  const auto r = static_cast<btScalar>(radius);
  auto cylinder = std::make_unique<btCylinderShapeZ>(btVector3(r, r, static_cast<btScalar>(half_length)));
  cylinder->setMargin(0);
  return cylinder;
}

const double kHalf = std::sqrt(0.5);
const double kThird = std::sqrt(1.0 / 3);

TEST(PointDistance, Sphere) {
  check(
      btSphereShape(btScalar(0.01)),
      {{{0.03, 0, 0}, 0.02, {1, 0, 0}}, {{0, -0.004, 0}, -0.006, {0, -1, 0}}, {{0.03, 0, 0.04}, 0.04, {0.6, 0, 0.8}}});
}

TEST(PointDistance, CapsuleSideAndEnds) {
  check(btCapsuleShapeZ(btScalar(0.006), btScalar(0.02)), {{{0.01, 0, 0.005}, 0.004, {1, 0, 0}},
                                                           {{0, -0.001, -0.0099}, -0.005, {0, -1, 0}},
                                                           {{0, 0, 0.02}, 0.004, {0, 0, 1}},
                                                           {{0, 0, -0.012}, -0.004, {0, 0, -1}},
                                                           {{0.003, 0, 0.014}, -0.001, {0.6, 0, 0.8}}});
}

TEST(PointDistance, BoxFacesEdgesCorners) {
  const auto box = makeBox(0.01, 0.02, 0.03);
  check(*box, {{{0.013, 0.001, 0.002}, 0.003, {1, 0, 0}},
               {{0.002, -0.025, 0.029}, 0.005, {0, -1, 0}},
               {{0.001, 0.002, 0.0299}, -0.0001, {0, 0, 1}},
               {{-0.009, 0.001, 0.002}, -0.001, {-1, 0, 0}},
               {{0.011, 0.021, 0.002}, 0.001 * std::sqrt(2), {kHalf, kHalf, 0}},
               {{0.011, -0.021, 0.031}, 0.001 * std::sqrt(3), {kThird, -kThird, kThird}}});
}

TEST(PointDistance, CylinderSideEndRim) {
  const auto cylinder = makeCylinder(0.01, 0.03);
  check(*cylinder, {{{0.014, 0, 0.01}, 0.004, {1, 0, 0}},
                    {{0, -0.009, 0}, -0.001, {0, -1, 0}},
                    {{0.001, 0, -0.034}, 0.004, {0, 0, -1}},
                    {{0.002, 0.003, 0.0295}, -0.0005, {0, 0, 1}},
                    {{0.013, 0, 0.034}, 0.005, {0.6, 0, 0.8}}});
}

TEST(PointDistance, KnowsTheAxisOfBulletsOtherCylindersAndCapsules) {
  btCylinderShapeX along_x(btVector3(btScalar(0.03), btScalar(0.01), btScalar(0.01)));
  along_x.setMargin(0);
  check(along_x, {{{0.034, 0.001, 0}, 0.004, {1, 0, 0}}, {{0.01, 0, 0.014}, 0.004, {0, 0, 1}}});
  btCylinderShape along_y(btVector3(btScalar(0.01), btScalar(0.03), btScalar(0.01)));
  along_y.setMargin(0);
  check(along_y, {{{0, -0.034, 0.001}, 0.004, {0, -1, 0}}, {{0.014, 0.02, 0}, 0.004, {1, 0, 0}}});
  check(btCapsuleShapeX(btScalar(0.006), btScalar(0.02)), {{{0.02, 0, 0}, 0.004, {1, 0, 0}}});
}

// signed distances in their usual closed forms, written independently of the code under test
double sphereDistance(const Vector3d& p) {
  return p.norm() - 0.01;
}
double capsuleDistance(const Vector3d& p) {
  const double t = std::min(1.0, std::max(0.0, (p.z() + 0.01) / 0.02));
  return (p - Vector3d(0, 0, -0.01 + 0.02 * t)).norm() - 0.006;
}
double boxDistance(const Vector3d& p) {
  const Vector3d q = p.cwiseAbs() - Vector3d(0.01, 0.02, 0.03);
  return q.cwiseMax(0).norm() + std::min(q.maxCoeff(), 0.0);
}
double cylinderDistance(const Vector3d& p) {
  const Eigen::Vector2d q(std::hypot(p.x(), p.y()) - 0.01, std::abs(p.z()) - 0.03);
  return q.cwiseMax(0).norm() + std::min(q.maxCoeff(), 0.0);
}

struct Reference {
  const char* name;
  std::shared_ptr<const btConvexShape> shape;
  std::function<double(const Vector3d&)> distance;
};

std::vector<Reference> references() {
  return {{"sphere", std::make_shared<btSphereShape>(btScalar(0.01)), sphereDistance},
          {"capsule", std::make_shared<btCapsuleShapeZ>(btScalar(0.006), btScalar(0.02)), capsuleDistance},
          {"box", makeBox(0.01, 0.02, 0.03), boxDistance},
          {"cylinder", makeCylinder(0.01, 0.03), cylinderDistance}};
}

std::vector<Vector3d> randomPoints(int count, double reach) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> coordinate(-reach, reach);
  std::vector<Vector3d> points;
  for (int i = 0; i < count; ++i) points.emplace_back(coordinate(random), coordinate(random), coordinate(random));
  return points;
}

TEST(PointDistance, AgreesWithClosedFormsInsideAndOutside) {
  for (const Reference& reference : references()) {
    const PointDistance distance(*reference.shape);
    int inside = 0;
    for (const Vector3d& p : randomPoints(5000, 0.04)) {
      Vector3d normal;
      const double d = distance(p, normal);
      ASSERT_NEAR(d, reference.distance(p), kExact) << reference.name << " at " << p.transpose();
      ASSERT_NEAR(normal.norm(), 1, 1e-12);
      ASSERT_NEAR(reference.distance(p - d * normal), 0, kExact)
          << reference.name << ": the normal leads to the surface";
      if (d < 0) ++inside;
    }
    EXPECT_GT(inside, 30) << reference.name;
  }
}

TEST(PointDistance, AgreesWithGjk) {
  for (const Reference& reference : references()) {
    double worst = 0;
    for (const Vector3d& p : randomPoints(2000, 0.04)) {
      const double exact = reference.distance(p);
      Vector3d normal;
      const double d = PointDistance::byGjk(*reference.shape, p, normal);
      worst = std::max(worst, std::abs(d - exact));
      ASSERT_NEAR(normal.norm(), 1, 1e-9);
      if (std::abs(exact) > 0.002) {
        EXPECT_NEAR(reference.distance(p - d * normal), 0, 10 * kGjkError) << reference.name << " " << p.transpose();
      }
    }
    EXPECT_LT(worst, kGjkError) << reference.name;
  }
}

TEST(PointDistance, TakesOtherConvexShapesByGjk) {
  btConvexHullShape hull;
  for (int corner = 0; corner < 8; ++corner)
    hull.addPoint(btVector3(btScalar((corner & 1) != 0 ? 0.01 : -0.01), btScalar((corner & 2) != 0 ? 0.02 : -0.02),
                            btScalar((corner & 4) != 0 ? 0.03 : -0.03)));
  hull.setMargin(0);
  const PointDistance distance(hull);
  for (const Vector3d& p : randomPoints(2000, 0.04)) {
    Vector3d normal;
    ASSERT_NEAR(distance(p, normal), boxDistance(p), kGjkError) << p.transpose();
  }
}

TEST(PointDistance, HonoursTheMarginThatRoundsABox) {
  btBoxShape rounded(btVector3(btScalar(0.01), btScalar(0.02), btScalar(0.03)));
  rounded.setMargin(btScalar(0.004));
  Vector3d normal;
  const double at_corner = PointDistance(rounded)({0.01, 0.02, 0.03}, normal);
  EXPECT_NEAR(at_corner, 0.004 * (std::sqrt(3) - 1), kGjkError) << "the corner of the box lies outside";
}

TEST(PointDistance, AlwaysHasAFiniteUnitNormal) {
  btConvexHullShape hull;
  for (const auto& v : {btVector3(1, 0, 0), btVector3(-1, 0, 0), btVector3(0, 1, 0), btVector3(0, -1, 0),
                        btVector3(0, 0, 1), btVector3(0, 0, -1)})
    hull.addPoint(v * btScalar(0.01));
  hull.setMargin(0);
  std::vector<Reference> all = references();
  all.push_back({"octahedron", std::make_shared<btConvexHullShape>(hull), {}});
  const double tiny = std::numeric_limits<double>::denorm_min();
  for (const Reference& reference : all) {
    const PointDistance distance(*reference.shape);
    for (const Vector3d& p :
         {Vector3d(0, 0, 0), Vector3d(0, 0, 0.005), Vector3d(0, 0, 0.01), Vector3d(0, 0, 0.016), Vector3d(0, 0, 0.03),
          Vector3d(0.01, 0, 0), Vector3d(0.01, 0.02, 0.03), Vector3d(1e-16, 0, 0), Vector3d(tiny, -tiny, tiny),
          Vector3d(1e-170, 1e-170, 0), Vector3d(0.01 + 1e-16, 0, 0), Vector3d(-0.0, -0.0, -0.0), Vector3d(1e3, 0, 0)}) {
      Vector3d normal;
      const double d = distance(p, normal);
      EXPECT_TRUE(std::isfinite(d)) << reference.name << " at " << p.transpose();
      EXPECT_NEAR(normal.norm(), 1, 1e-9) << reference.name << " at " << p.transpose();
    }
  }
}

}  // namespace
}  // namespace vibe::point_distance_test
