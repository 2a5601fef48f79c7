#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

/// A straight line of sight of limited length.
struct Ray {
  Eigen::Vector3d start, direction;  ///< in world [m]; unit vector
  double length;                     ///< [m]

  Ray(const Eigen::Vector3d& start, const Eigen::Vector3d& unit, double length);
  Eigen::Vector3d at(double distance) const { return start + distance * direction; }
};

struct RayHit {
  int triangle = -1;    ///< -1: none
  double distance = 0;  ///< along the ray [m]
};

/// The first triangle that a ray meets, from either side; of several at one distance the one with the lowest number.
/// Triangles with corners that are not finite are not met.
RayHit firstHit(const Ray& ray, const SurfaceView& surface);

/// Twice the area vector of a triangle, outwards.
Eigen::Vector3d areaVector(const SurfaceView& surface, const std::array<int, 3>& triangle);

}  // namespace vibe
