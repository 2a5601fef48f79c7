#include "vibe_testing/wall_crossings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>

namespace vibe::wall_crossings_test {
namespace {

using Eigen::Vector3d;
using namespace test;

struct Sheet {
  std::vector<std::array<int, 3>> triangles;
  std::vector<double> x, y, z;
  SurfaceView view() const { return {triangles, x, y, z}; }
  int add(const Vector3d& p) {
    x.push_back(p.x()), y.push_back(p.y()), z.push_back(p.z());
    return static_cast<int>(x.size()) - 1;
  }
  void addTriangle(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    triangles.push_back({add(a), add(b), add(c)});
  }
};

/// n x n squares of 1 mm in the plane through `origin` along u and v.
void addGrid(int n, const Vector3d& origin, const Vector3d& u, const Vector3d& v, Sheet& sheet) {
  const int first = static_cast<int>(sheet.x.size());
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) sheet.add(origin + 1e-3 * (i * u + j * v));
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const int a = first + i * (n + 1) + j, b = a + n + 1;
      sheet.triangles.push_back({a, b, b + 1});
      sheet.triangles.push_back({a, b + 1, a + 1});
    }
}

std::size_t countByAllPairs(const Sheet& sheet) {
  std::size_t count = 0;
  const auto corners = [&](std::size_t t) {
    const auto& c = sheet.triangles[t];
    const SurfaceView view = sheet.view();
    return std::array<Vector3d, 3>{view.position(c[0]), view.position(c[1]), view.position(c[2])};
  };
  for (std::size_t a = 0; a < sheet.triangles.size(); ++a)
    for (std::size_t b = a + 1; b < sheet.triangles.size(); ++b) {
      bool shared = false;
      for (const int v : sheet.triangles[a])
        for (const int w : sheet.triangles[b]) shared = shared || v == w;
      if (!shared && trianglesCross(corners(a), corners(b))) ++count;
    }
  return count;
}

const std::array<Vector3d, 3> kFlat{Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 1, 0)};

TEST(WallCrossings, ASegmentPiercesWhereItPassesThroughTheInside) {
  EXPECT_TRUE(segmentPierces({0.2, 0.2, -1}, {0.2, 0.2, 1}, kFlat));
  EXPECT_TRUE(segmentPierces({0.2, 0.2, 1}, {0.2, 0.2, -1}, kFlat));
  EXPECT_FALSE(segmentPierces({0.8, 0.8, -1}, {0.8, 0.8, 1}, kFlat));   // beside it
  EXPECT_FALSE(segmentPierces({0.2, 0.2, 0.1}, {0.2, 0.2, 1}, kFlat));  // above it
  EXPECT_FALSE(segmentPierces({0.2, 0.2, 0}, {0.2, 0.2, 1}, kFlat));    // begins on it
  EXPECT_FALSE(segmentPierces({0.2, -1, 0}, {0.2, 2, 0}, kFlat));       // in its plane
}

TEST(WallCrossings, TrianglesCrossInEitherOrder) {
  const std::array<Vector3d, 3> through{Vector3d(0.2, 0.2, -1), Vector3d(0.2, 0.2, 1), Vector3d(5, 5, 1)};
  const std::array<Vector3d, 3> above{Vector3d(0, 0, 0.01), Vector3d(1, 0, 0.01), Vector3d(0, 1, 0.01)};
  const std::array<Vector3d, 3> touching{Vector3d(0.2, 0.2, 0), Vector3d(1, 0, 1), Vector3d(0, 1, 1)};
  // two of its edges pass through the flat one and none of the flat one's through it
  const std::array<Vector3d, 3> needle{Vector3d(0.2, 0.2, -1), Vector3d(0.21, 0.2, 1), Vector3d(0.2, 0.21, 1)};
  for (const auto& other : {through, needle}) {
    EXPECT_TRUE(trianglesCross(kFlat, other));
    EXPECT_TRUE(trianglesCross(other, kFlat));
  }
  for (const auto& other : {above, touching}) {
    EXPECT_FALSE(trianglesCross(kFlat, other));
    EXPECT_FALSE(trianglesCross(other, kFlat));
  }
}

TEST(WallCrossings, NeighboursDoNotCountAndEverybodyElseDoes) {
  Sheet sheet;
  const int a = sheet.add({0, 0, 0}), b = sheet.add({1, 0, 0}), c = sheet.add({0, 1, 0});
  const int d = sheet.add({0.3, 0.3, -1}), e = sheet.add({0.3, 0.3, 1});
  sheet.triangles = {{a, b, c}, {a, d, e}};  // the second passes through the first, with a common vertex
  EXPECT_TRUE(findWallCrossings(sheet.view()).empty());
  sheet.triangles[1][0] = sheet.add({2, 2, 0});
  ASSERT_EQ(findWallCrossings(sheet.view()).size(), 1u);
  EXPECT_EQ(findWallCrossings(sheet.view()).front(), (CrossingPair{0, 1}));
}

TEST(WallCrossings, ParallelSheetsDoNotCross) {
  Sheet sheet;
  addGrid(10, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, sheet);
  addGrid(10, {0.3e-3, 0.2e-3, 1e-6}, {1, 0, 0}, {0, 1, 0}, sheet);
  EXPECT_TRUE(findWallCrossings(sheet.view()).empty());
}

TEST(WallCrossings, FindsWhatAllPairsFindOnRandomAndOnRegularSurfaces) {
  Sheet sheet;
  addGrid(12, {0, 0, 0}, {1, 0, 0.013}, {0, 1, 0.021}, sheet);
  addGrid(12, {0.31e-3, 5.17e-3, -4.3e-3}, {1, 0.011, 0}, {0.017, 0.03, 1}, sheet);
  std::uint32_t random = 7;
  const auto next = [&random] { return (random = random * 1664525u + 1013904223u) / 4294967296.0; };
  for (int k = 0; k < 40; ++k) {
    const Vector3d p = 1e-2 * Vector3d(next(), next(), next());
    sheet.addTriangle(p, p + 4e-3 * Vector3d(next(), next(), next()), p - 4e-3 * Vector3d(next(), next(), next()));
  }
  const std::size_t expected = countByAllPairs(sheet);
  EXPECT_GT(expected, 50u);
  EXPECT_EQ(findWallCrossings(sheet.view()).size(), expected);
}

TEST(WallCrossings, OneLargeTriangleDoesNotHideTheSmallOnes) {
  Sheet sheet;
  addGrid(10, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, sheet);
  sheet.addTriangle({5.3e-3, -1, -1}, {5.3e-3, 1, -1}, {5.3e-3, 0.1, 1});
  EXPECT_EQ(findWallCrossings(sheet.view()).size(), countByAllPairs(sheet));
  EXPECT_EQ(countByAllPairs(sheet), 20u);  // both halves of the ten squares in its way
}

TEST(WallCrossings, PositionsThatAreNotFiniteCrossNothing) {
  Sheet sheet;
  addGrid(2, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, sheet);
  sheet.x[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(findWallCrossings(sheet.view()).empty());
  EXPECT_TRUE(findWallCrossings(Sheet().view()).empty());
}

}  // namespace
}  // namespace vibe::wall_crossings_test
