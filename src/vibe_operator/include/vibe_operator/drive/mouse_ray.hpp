#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace vibe::operating {

/// A half-line: what lies under the mouse.
struct MouseRay {
  Eigen::Vector3d origin;     ///< [m]
  Eigen::Vector3d direction;  ///< unit
};

/// Where a ray meets a surface.
struct MouseHit {
  std::size_t triangle = 0;    ///< number of the triangle
  std::uint32_t particle = 0;  ///< nearest corner of this triangle
  double distance = 0;         ///< from the ray's origin [m]
  Eigen::Vector3d place;       ///< [m]
};

/// The first triangle that a ray hits, from either side; empty if it hits none. Triangles behind the origin, without
/// area, or with corners that do not exist or are not finite are skipped.
/// @param positions  x y z per corner [m]
/// @param triangles  three corner numbers each
std::optional<MouseHit> firstHit(const MouseRay& ray, const std::vector<float>& positions,
                                 const std::vector<std::uint32_t>& triangles);

/// Where a ray meets the plane through `place` with this normal; empty if it is parallel or points away.
std::optional<Eigen::Vector3d> meetPlane(const MouseRay& ray, const Eigen::Vector3d& place,
                                         const Eigen::Vector3d& normal);

}  // namespace vibe::operating
