#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace vibe::graphics {

/// All points that are at most `radius` away from a segment [m].
struct Capsule {
  Eigen::Vector3d from, to;  ///< ends of the segment [m]
  double radius = 0;         ///< about the segment [m]
};

/// Capsules that cast about the same shadow as a mesh: one for each connected part, up to eight for a bent one. The
/// radius is the root mean square distance of the surface from the axis of the part, so a hollow or flat part is as
/// wide as it is on average. Parts of fewer than four triangles are left out.
/// @param points     [m]
/// @param triangles  three points each; corners at the same place are connected
std::vector<Capsule> fitCapsules(const std::vector<Eigen::Vector3f>& points,
                                 const std::vector<std::uint32_t>& triangles);

}  // namespace vibe::graphics
