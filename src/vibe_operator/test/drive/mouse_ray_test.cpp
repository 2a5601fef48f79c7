#include "vibe_operator/drive/mouse_ray.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

namespace vibe::operating::mouse_ray_test {
namespace {

using Eigen::Vector3d;

// A unit cube about the origin, twelve triangles, outwards.
const std::vector<float> kCube = {-.5F, -.5F, -.5F, .5F, -.5F, -.5F, .5F, .5F, -.5F, -.5F, .5F, -.5F,
                                  -.5F, -.5F, .5F,  .5F, -.5F, .5F,  .5F, .5F, .5F,  -.5F, .5F, .5F};
const std::vector<std::uint32_t> kFaces = {0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                                           1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7};

MouseRay towards(const Vector3d& origin, const Vector3d& place) {
  return {origin, (place - origin).normalized()};
}

TEST(MouseHit, NearFaceIsHitFromOutside) {
  const auto hit = firstHit(towards({3, 0.1, 0.2}, {0.5, 0.1, 0.2}), kCube, kFaces);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->distance, 2.5, 1e-12);
  EXPECT_LT((hit->place - Vector3d(0.5, 0.1, 0.2)).norm(), 1e-12);
  EXPECT_EQ(hit->particle, 6U);  // the corner at (.5, .5, .5)
}

TEST(MouseHit, WallIsHitFromInside) {
  const auto hit = firstHit(towards({0.1, 0, 0}, {-2, 0.3, -0.1}), kCube, kFaces);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->place.x(), -0.5, 1e-12);
}

TEST(MouseHit, TrianglesBehindAndBesideAreNotHit) {
  EXPECT_FALSE(firstHit(towards({3, 0, 0}, {4, 0, 0}), kCube, kFaces));
  EXPECT_FALSE(firstHit(towards({3, 0, 0}, {0.5, 0.51, 0}), kCube, kFaces));
  EXPECT_TRUE(firstHit(towards({3, 0, 0}, {0.5, 0.49, 0}), kCube, kFaces));
  EXPECT_FALSE(firstHit(towards({3, 0, 0}, {0, 0, 0}), kCube, {}));
}

// No ray from inside may escape, not even through edges and corners.
TEST(MouseHit, ClosedSurfaceHasNoHoles) {
  for (int i = 0; i <= 40; ++i)
    for (int j = 0; j <= 40; ++j) {
      const Vector3d aim(0.5, -0.5 + i / 40.0, -0.5 + j / 40.0);
      EXPECT_TRUE(firstHit(towards({0, 0, 0}, aim), kCube, kFaces)) << aim.transpose();
    }
}

TEST(MouseHit, HitMovesWithTheSurface) {
  const Eigen::Isometry3d motion =
      Eigen::Translation3d(1, -2, 3) * Eigen::AngleAxisd(1.1, Vector3d(1, 2, 3).normalized());
  std::vector<float> moved;
  for (std::size_t i = 0; i < kCube.size(); i += 3) {
    const Vector3d p = motion * Vector3d(kCube[i], kCube[i + 1], kCube[i + 2]);
    for (int k = 0; k < 3; ++k) moved.push_back(static_cast<float>(p[k]));
  }
  const MouseRay ray = towards({2, 0.7, 0.4}, {0.1, -0.2, 0.3});
  const auto there = firstHit(ray, kCube, kFaces);
  const auto here = firstHit({motion * ray.origin, motion.linear() * ray.direction}, moved, kFaces);
  ASSERT_TRUE(there && here);
  EXPECT_EQ(there->triangle, here->triangle);
  EXPECT_EQ(there->particle, here->particle);
  EXPECT_NEAR(there->distance, here->distance, 1e-6);
}

TEST(MouseHit, InvalidTrianglesAreSkipped) {
  std::vector<float> positions = kCube;
  std::vector<std::uint32_t> faces = {1, 1, 2, 900, 901, 902};  // no area; no such corners
  faces.insert(faces.end(), kFaces.begin(), kFaces.end());
  const MouseRay ray = towards({3, 0.1, 0.2}, {0.5, 0.1, 0.2});
  ASSERT_TRUE(firstHit(ray, positions, faces));
  for (std::uint32_t corner : {1U, 2U, 5U, 6U}) positions[3 * corner] = std::numeric_limits<float>::quiet_NaN();
  const auto hit = firstHit(ray, positions, faces);  // the near face is gone, the far one is not
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->place.x(), -0.5, 1e-12);
}

TEST(MeetPlane, PointIsOnTheRayAndInThePlane) {
  const MouseRay ray = towards({1, 2, 3}, {0, 0, 0});
  const Vector3d place(0.3, 0.1, -0.2), normal(0.2, 1, 0.5);
  const auto met = meetPlane(ray, place, normal);
  ASSERT_TRUE(met);
  EXPECT_NEAR(normal.dot(*met - place), 0, 1e-12);
  EXPECT_LT((*met - ray.origin).normalized().cross(ray.direction).norm(), 1e-12);
}

TEST(MeetPlane, ParallelAndRecedingRaysMeetNothing) {
  EXPECT_FALSE(meetPlane({{0, 0, 1}, {1, 0, 0}}, {0, 0, 0}, {0, 0, 1}));
  EXPECT_FALSE(meetPlane({{0, 0, 1}, {0, 0, 1}}, {0, 0, 0}, {0, 0, 1}));
  EXPECT_TRUE(meetPlane({{0, 0, 1}, {0, 0, -1}}, {0, 0, 0}, {0, 0, 1}));
}

}  // namespace
}  // namespace vibe::operating::mouse_ray_test
