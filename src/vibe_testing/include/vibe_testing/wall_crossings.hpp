#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include <Eigen/Geometry>

#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe::test {

using TriangleCorners = std::array<Eigen::Vector3d, 3>;  ///< [m]

/// Corners of a triangle of the wall [m].
inline TriangleCorners cornersOf(const SurfaceView& wall, std::size_t triangle) {
  const auto& corner = wall.triangles[triangle];
  return {wall.position(corner[0]), wall.position(corner[1]), wall.position(corner[2])};
}

/// Whether the open segment passes through the triangle. A point nearer to its plane than 1e-12 of the size is in it:
/// above the rounding error of coordinates that are a hundred times as large, and far below a nanometre.
inline bool segmentPierces(const Eigen::Vector3d& begin, const Eigen::Vector3d& end, const TriangleCorners& triangle) {
  const auto& [a, b, c] = triangle;
  const auto volume = [](const auto& p, const auto& q, const auto& r, const auto& s) {
    return (q - p).cross(r - p).dot(s - p);
  };
  const double rounding = 1e-12 * (b - a).norm() * (c - a).norm() * (end - begin).norm();
  const double from = volume(a, b, c, begin), to = volume(a, b, c, end);
  if (!(std::min(from, to) < -rounding && std::max(from, to) > rounding)) return false;
  const double ab = volume(begin, end, a, b), bc = volume(begin, end, b, c), ca = volume(begin, end, c, a);
  return (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
}

/// Whether two triangles intersect: an edge of one passes through the other. Touching does not count.
inline bool trianglesCross(const TriangleCorners& a, const TriangleCorners& b) {
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    if (segmentPierces(a[k], a[next], b) || segmentPierces(b[k], b[next], a)) return true;
  }
  return false;
}

/// Two triangle numbers, the smaller first.
using CrossingPair = std::array<int, 2>;

/// The triangles of a wall that pass through each other, in ascending order. All pairs without a common vertex count,
/// however near they are along the surface. Triangles that only touch, and triangles in one plane, do not count; a
/// triangle with a position that is not finite crosses nothing. To check the simulation from outside: it shares nothing
/// with its contact.
inline std::vector<CrossingPair> findWallCrossings(const SurfaceView& wall) {
  struct Box {
    Eigen::Array3d low, high;
  };
  std::vector<Box> boxes;
  std::vector<std::size_t> order;  // along x
  for (std::size_t t = 0; t < wall.triangles.size(); ++t) {
    const auto [a, b, c] = cornersOf(wall, t);
    boxes.push_back({a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)});
    if (a.allFinite() && b.allFinite() && c.allFinite()) order.push_back(t);
  }
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return boxes[a].low.x() < boxes[b].low.x(); });
  const auto shareVertex = [&](std::size_t a, std::size_t b) {
    const auto &p = wall.triangles[a], &q = wall.triangles[b];
    return std::any_of(p.begin(), p.end(), [&](int v) { return std::count(q.begin(), q.end(), v) > 0; });
  };
  std::vector<CrossingPair> found;
  for (auto i = order.begin(); i != order.end(); ++i)
    for (auto j = i + 1; j != order.end() && boxes[*j].low.x() <= boxes[*i].high.x(); ++j) {
      const Box &a = boxes[*i], &b = boxes[*j];
      if ((a.low > b.high).any() || (b.low > a.high).any() || shareVertex(*i, *j)) continue;
      if (trianglesCross(cornersOf(wall, *i), cornersOf(wall, *j)))
        found.push_back({static_cast<int>(std::min(*i, *j)), static_cast<int>(std::max(*i, *j))});
    }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace vibe::test
