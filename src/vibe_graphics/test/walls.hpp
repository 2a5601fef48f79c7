#pragma once
#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "vibe_graphics/geometry/wall_surface.hpp"

namespace vibe::graphics::test {

/// A wall that is a height over a square: the lumen is above, so triangles are counter-clockwise seen from below.
struct HeightWall {
  std::vector<MovingVertex> vertices;
  std::vector<std::uint32_t> triangles;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();

  /// @param half    of the side of the square [m]
  /// @param height  z over x and y [m]; normals are those of this function
  HeightWall(std::uint32_t rows, double half, const std::function<double(double, double)>& height) {
    for (std::uint32_t j = 0; j < rows; ++j)
      for (std::uint32_t i = 0; i < rows; ++i) {
        const double x = half * (2.0 * i / (rows - 1) - 1), y = half * (2.0 * j / (rows - 1) - 1), e = 1e-6;
        const Eigen::Vector3d outward((height(x + e, y) - height(x - e, y)) / (2 * e),
                                      (height(x, y + e) - height(x, y - e)) / (2 * e), -1);
        const Eigen::Vector3f p = Eigen::Vector3d(x, y, height(x, y)).cast<float>(),
                              n = outward.normalized().cast<float>();
        vertices.push_back({{p.x(), p.y(), p.z()}, {n.x(), n.y(), n.z()}});
      }
    for (std::uint32_t j = 0; j + 1 < rows; ++j)
      for (std::uint32_t i = 0; i + 1 < rows; ++i) {
        const std::uint32_t a = j * rows + i, b = a + 1, c = a + rows, d = c + 1;
        triangles.insert(triangles.end(), {a, d, b, a, c, d});
      }
  }

  WallSurface surface() const {
    WallSurface wall(triangles, vertices.size());
    wall.move(vertices, pose);
    return wall;
  }
};

constexpr double kBowlRadius = 0.04;  // [m]

/// Lower part of a sphere of 40 mm with its lowest point at the origin; flat beyond 36 mm from the axis.
inline double bowl(double x, double y) {
  const double square = std::min(x * x + y * y, 0.036 * 0.036);
  return kBowlRadius - std::sqrt(kBowlRadius * kBowlRadius - square);
}

/// Height of the level over the lowest point of a spherical bowl that holds a volume V = pi h^2 (R - h / 3).
inline double capHeight(double volume, double radius = kBowlRadius) {
  double low = 0, high = radius;
  for (int k = 0; k < 60; ++k) {
    const double h = 0.5 * (low + high);
    (3.14159265358979 * h * h * (radius - h / 3) < volume ? low : high) = h;
  }
  return low;
}

}  // namespace vibe::graphics::test
