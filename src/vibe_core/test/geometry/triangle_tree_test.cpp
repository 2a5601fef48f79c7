#include "vibe_core/geometry/triangle_tree.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <set>
#include <utility>

#include "geometry/test_surfaces.hpp"

namespace vibe::triangle_tree_test {
namespace {

using test::makeBox;
using test::makeUvSphere;

Eigen::Vector3d randomPoint(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> uniform(-size, size);
  const double x = uniform(random), y = uniform(random);
  return {x, y, uniform(random)};
}

TEST(TriangleTree, findsTheSameNearestPointAsASearchOfAllTriangles) {
  const SurfaceMesh sphere = makeUvSphere(0.05, 13, 21);
  const TriangleTree tree(sphere);
  std::mt19937 random(1);
  for (int k = 0; k < 300; ++k) {
    const Eigen::Vector3d p = randomPoint(random, 0.1);
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto& t : sphere.triangles) {
      const Eigen::Vector3d q =
          closestPointOnTriangle(p, sphere.vertices[t[0]], sphere.vertices[t[1]], sphere.vertices[t[2]]);
      nearest = std::min(nearest, (q - p).norm());
    }
    EXPECT_DOUBLE_EQ(tree.closest(p).distance, nearest);
  }
}

TEST(TriangleTree, nearestPointOfATriangleOnFaceEdgeAndCorner) {
  const Eigen::Vector3d a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
  EXPECT_LT((closestPointOnTriangle({0.2, 0.2, 5}, a, b, c) - Eigen::Vector3d(0.2, 0.2, 0)).norm(), 1e-15);
  EXPECT_LT((closestPointOnTriangle({1, 1, 0}, a, b, c) - Eigen::Vector3d(0.5, 0.5, 0)).norm(), 1e-15);
  EXPECT_LT((closestPointOnTriangle({0.5, -3, 1}, a, b, c) - Eigen::Vector3d(0.5, 0, 0)).norm(), 1e-15);
  EXPECT_LT((closestPointOnTriangle({-1, 0.5, 1}, a, b, c) - Eigen::Vector3d(0, 0.5, 0)).norm(), 1e-15);
  EXPECT_LT((closestPointOnTriangle({-1, -1, 1}, a, b, c) - a).norm(), 1e-15);
  EXPECT_LT((closestPointOnTriangle({4, -1, 1}, a, b, c) - b).norm(), 1e-15);
  EXPECT_LT((closestPointOnTriangle({-1, 4, 1}, a, b, c) - c).norm(), 1e-15);
}

TEST(TriangleTree, rayLeavesABoxAtItsSide) {
  const TriangleTree tree(makeBox(0.2, 0.4, 0.6));
  EXPECT_NEAR(tree.firstHit({0.01, 0.02, 0.03}, Eigen::Vector3d::UnitX()), 0.09, 1e-15);
  EXPECT_NEAR(tree.firstHit({0.01, 0.02, 0.03}, -Eigen::Vector3d::UnitZ()), 0.33, 1e-15);
  EXPECT_EQ(tree.firstHit({1, 0, 0}, Eigen::Vector3d::UnitX()), std::numeric_limits<double>::infinity());
}

TEST(TriangleTree, whatIsBetweenTwoPlacesIsFoundAlsoWhereTheSurfaceHasMoved) {
  SurfaceMesh surface = makeUvSphere(0.05, 13, 21);
  TriangleTree tree(surface);
  std::vector<double> x, y, z;
  for (Eigen::Vector3d& v : surface.vertices) {
    v = Eigen::Vector3d(v.z(), 2 * v.x() + 0.01, v.y());
    x.push_back(v.x()), y.push_back(v.y()), z.push_back(v.z());
  }
  tree.moveTo(x, y, z);
  const TriangleTree made_there(surface);
  std::mt19937 random(2);
  int between = 0;
  for (int k = 0; k < 400; ++k) {
    const Eigen::Vector3d a = randomPoint(random, 0.1), b = randomPoint(random, 0.1);
    const bool expected = made_there.firstHit(a, (b - a).normalized()) < (b - a).norm();
    EXPECT_EQ(tree.isBetween(a, b), expected);
    between += expected ? 1 : 0;
  }
  EXPECT_GT(between, 50);
  EXPECT_LT(between, 350) << "control";
}

TEST(TriangleTree, pairsAreThoseWithOverlappingBoxesAndComeOnce) {
  const SurfaceMesh sphere = makeUvSphere(0.05, 8, 9);
  const TriangleTree tree(sphere);
  std::multiset<std::pair<int, int>> found;
  tree.overlappingPairs([&](int a, int b) {
    found.emplace(a, b);
    return true;
  });
  std::multiset<std::pair<int, int>> expected;
  const auto box = [&](const std::array<int, 3>& t) {
    Eigen::AlignedBox3d b;
    for (const int v : t) b.extend(sphere.vertices[v]);
    return b;
  };
  for (int a = 0; a < static_cast<int>(sphere.triangles.size()); ++a) {
    for (int b = a + 1; b < static_cast<int>(sphere.triangles.size()); ++b) {
      if (box(sphere.triangles[a]).intersects(box(sphere.triangles[b]))) expected.emplace(a, b);
    }
  }
  EXPECT_EQ(found, expected);
}

TEST(TriangleTree, emptySurfaceHasNoNearestPoint) {
  EXPECT_EQ(TriangleTree(SurfaceMesh{}).closest({0, 0, 0}).triangle, -1);
}

}  // namespace
}  // namespace vibe::triangle_tree_test
