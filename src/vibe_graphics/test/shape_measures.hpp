#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "vibe_graphics/geometry/coloured_shape.hpp"

namespace vibe::graphics {

// What is measured of shapes in tests.

inline Eigen::Vector3d placeOf(const ColouredShape& shape, std::size_t vertex) {
  const float* p = shape.vertices[vertex].position;
  return {p[0], p[1], p[2]};
}

inline Eigen::Vector3d normalOf(const ColouredShape& shape, std::size_t vertex) {
  const float* n = shape.vertices[vertex].normal;
  return {n[0], n[1], n[2]};
}

/// Enclosed volume, positive if triangles are counter-clockwise seen from outside [m^3].
inline double volumeOf(const ColouredShape& shape) {
  double sum = 0;
  for (std::size_t t = 0; t + 2 < shape.triangles.size(); t += 3)
    sum += placeOf(shape, shape.triangles[t])
               .dot(placeOf(shape, shape.triangles[t + 1]).cross(placeOf(shape, shape.triangles[t + 2])));
  return sum / 6;
}

/// Every edge is used once in each direction: the surface has no hole and all triangles agree on what is outside.
inline bool isClosed(const ColouredShape& shape) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
  for (std::size_t t = 0; t + 2 < shape.triangles.size(); t += 3)
    for (std::size_t k = 0; k < 3; ++k) ++uses[{shape.triangles[t + k], shape.triangles[t + (k + 1) % 3]}];
  return std::all_of(uses.begin(), uses.end(), [&](const auto& edge) {
    const auto back = uses.find({edge.first.second, edge.first.first});
    return edge.second == 1 && back != uses.end() && back->second == 1;
  });
}

/// Colours and triangles fit the vertices, everything is finite, normals are unit.
inline bool isSound(const ColouredShape& shape) {
  if (shape.colours.size() != shape.vertices.size() || shape.triangles.size() % 3 != 0) return false;
  for (std::size_t v = 0; v < shape.vertices.size(); ++v)
    if (!placeOf(shape, v).allFinite() || std::abs(normalOf(shape, v).norm() - 1) > 1e-4) return false;
  return std::all_of(shape.triangles.begin(), shape.triangles.end(),
                     [&](std::uint32_t corner) { return corner < shape.vertices.size(); });
}

inline double distanceToSegment(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const double along = (b - a).squaredNorm() > 0 ? (p - a).dot(b - a) / (b - a).squaredNorm() : 0;
  return (p - a - std::clamp(along, 0.0, 1.0) * (b - a)).norm();
}

inline double distanceToLine(const Eigen::Vector3d& p, const std::vector<Eigen::Vector3d>& line) {
  double min = (p - line.front()).norm();
  for (std::size_t k = 1; k < line.size(); ++k) min = std::min(min, distanceToSegment(p, line[k - 1], line[k]));
  return min;
}

}  // namespace vibe::graphics
