#include "geometry/polygon.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "vibe_core/program/error.hpp"

namespace vibe::polygon_test {
namespace {

using Outline = std::vector<Eigen::Vector2d>;

const Outline kComb{{0, 0}, {4, 0}, {8, 0}, {8, 6}, {7, 6}, {7, 1}, {6, 1},
                    {6, 4}, {5, 4}, {5, 1}, {4, 1}, {2, 1}, {2, 7}, {0, 7}};

/// A closed curve that winds about the origin in a spiral band: every convex corner sees others.
Outline spiral(int corners) {
  Outline outline;
  for (const double width : {0.0, 0.6})
    for (int k = 0; k < corners; ++k) {
      const double turn = width == 0 ? k : corners - 1 - k, angle = 0.3 * turn, radius = 1 + 0.15 * angle + width * 0.5;
      outline.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
  return outline;
}

double area(const Outline& outline) {
  double twice = 0;
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const Eigen::Vector2d &a = outline[k], &b = outline[(k + 1) % outline.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return twice / 2;
}

struct Cut {
  bool done = false;
  std::vector<Eigen::Vector3d> points;
  std::vector<std::array<int, 3>> triangles;
};

/// The outline somewhere in space, begun at a corner.
Cut cut(const Outline& outline, std::size_t begin) {
  Cut result;
  const Eigen::AngleAxisd turn(1.1, Eigen::Vector3d(1, 2, -3).normalized());
  for (const auto& p : outline) result.points.push_back(turn * Eigen::Vector3d(p.x(), p.y(), 5));
  std::vector<int> corners(outline.size());
  std::iota(corners.begin(), corners.end(), 0);
  std::rotate(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(begin), corners.end());
  result.done = cutPolygon(result.points, corners, result.triangles);
  return result;
}

/// All triangles face the same side, have area, cover the polygon once, and have its sides.
void expectGood(const Cut& cut, const Outline& outline) {
  ASSERT_TRUE(cut.done);
  ASSERT_EQ(cut.triangles.size(), outline.size() - 2);
  const Eigen::Vector3d normal =
      Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, -3).normalized()) * Eigen::Vector3d::UnitZ();
  const double whole = std::abs(area(outline)), side = area(outline) > 0 ? 1 : -1;
  double sum = 0;
  std::set<std::pair<int, int>> sides;
  for (const auto& t : cut.triangles) {
    const Eigen::Vector3d a = cut.points[t[0]], b = cut.points[t[1]], c = cut.points[t[2]];
    const double part = side * 0.5 * (b - a).cross(c - a).dot(normal);
    EXPECT_GT(part, 1e-6 * whole);
    sum += part;
    for (int k = 0; k < 3; ++k) EXPECT_TRUE(sides.emplace(t[k], t[(k + 1) % 3]).second);
  }
  EXPECT_NEAR(sum / whole, 1, 1e-12);
  const int n = static_cast<int>(outline.size());
  for (int k = 0; k < n; ++k) EXPECT_EQ(sides.count({k, (k + 1) % n}), 1U) << k;
}

TEST(Polygon, IsCutFromEveryCorner) {
  const Outline square{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, arrow{{0, 0}, {4, -2}, {1, 0}, {4, 2}};
  const Outline five_on_an_edge{{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {2, 3}};
  for (Outline outline : {square, arrow, five_on_an_edge, kComb, spiral(30)})
    for (const bool turned : {false, true}) {
      if (turned) std::reverse(outline.begin(), outline.end());
      for (std::size_t begin = 0; begin < outline.size(); ++begin) expectGood(cut(outline, begin), outline);
    }
}

TEST(Polygon, KeepsCornersThatAreRoundedToAStraightEdge) {
  Outline outline{{0, 0}};
  for (int k = 1; k < 20; ++k) outline.emplace_back(0.37F * static_cast<float>(k), 0.11F * static_cast<float>(k));
  outline.emplace_back(0, 4);
  const Cut result = cut(outline, 0);
  ASSERT_TRUE(result.done);
  EXPECT_EQ(result.triangles.size(), outline.size() - 2);
}

TEST(Polygon, RefusesAnOutlineThatCrossesItself) {
  const Outline crossed{{0, 0}, {10, 0}, {10, 6}, {4, 6}, {4, -4}, {6, -4}, {6, 8}, {0, 8}};
  const Outline straight{{0, 0}, {10, 0}, {10, 6}, {4, 6}, {4, 7}, {6, 7}, {6, 8}, {0, 8}};
  EXPECT_TRUE(cut(straight, 0).done);  // control
  const Cut result = cut(crossed, 0);
  EXPECT_FALSE(result.done);
  EXPECT_TRUE(result.triangles.empty());
}

TEST(Polygon, WithoutAreaOrNumbersEnds) {
  EXPECT_TRUE(cut({{0, 0}, {1, 0}}, 0).triangles.empty());
  EXPECT_TRUE(cut({{1, 1}, {1, 1}, {1, 1}, {1, 1}}, 0).triangles.empty());
  EXPECT_EQ(cut({{0, 0}, {1, 0}, {1, 0}, {0, 1}, {0, 0}}, 0).triangles.size(), 1U);  // corners that repeat
  EXPECT_EQ(cut({{0, 0}, {1, 0}, {2, 0}, {3, 0}}, 0).triangles.size(), 2U);
  const double nan = std::numeric_limits<double>::quiet_NaN(), large = std::numeric_limits<double>::max();
  EXPECT_NO_THROW(cut({{0, 0}, {1, 0}, {nan, 0}, {0, 1}}, 0));
  EXPECT_NO_THROW(cut({{0, 0}, {large, 0}, {large, large}, {0, 1}}, 0));
}

TEST(Polygon, NamesAFaceOfTooManyCorners) {
  SurfaceMesh mesh;
  mesh.vertices.assign(3, Eigen::Vector3d::Zero());
  FaceList faces;
  faces.corners.assign(kMaxCorners + 1, 0);
  faces.ends = {faces.corners.size()};
  faces.places = {7};
  try {
    addFaces(faces, 1, "line", mesh);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("line 7: the face has 20001 corners"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace vibe::polygon_test
