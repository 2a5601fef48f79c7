#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "vibe_core/geometry/surface_mesh.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/procedure/stitch.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

/// The point of a straight path that is farthest outside of a closed surface.
struct DeepestPoint {
  int triangle = -1;                                ///< of the surface, nearest to the point; -1: it has none
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< on that triangle, nearest to the point of the path [m]
  double distance = 0;                              ///< of the point of the path from the surface, positive outside [m]
};

/// Samples the path from `begin` to `end`. The sign of the distance comes from the angle-weighted pseudonormal at the
/// nearest point (Baerentzen and Aanaes 2005, IEEE TVCG 11:243), which is also correct on edges and corners.
/// Cost: a loop over vertices and triangles; allocates. Meant for the closing of the arm, not for every step.
DeepestPoint deepestPoint(const SurfaceView& wall, const Eigen::Vector3d& begin, const Eigen::Vector3d& end);

/// Path of the needle's point through tissue as the arm closes, in world [m]: the last 70 % of the chord from its open
/// to its closed position. Before that the needle moves outside of the cap.
/// @param link_poses  of the tool's links in world; only that of the needle's link is used
/// @return begin and end
std::pair<Eigen::Vector3d, Eigen::Vector3d> needlePath(const Model& model,
                                                       const std::vector<Eigen::Isometry3d>& link_poses);

/// A bit for each side of a box beyond which a point lies: a triangle all of whose corners share one is outside.
inline std::uint8_t sidesBeyond(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& p) {
  const Eigen::Vector3d &low = box.min(), &high = box.max();
  return static_cast<std::uint8_t>((p.x() < low.x()) | (p.x() > high.x()) << 1 | (p.y() < low.y()) << 2 |
                                   (p.y() > high.y()) << 3 | (p.z() < low.z()) << 4 | (p.z() > high.z()) << 5);
}

/// How far the needle reaches into the deformed wall.
struct NeedleReach {
  double depth = 0;  ///< greatest depth below the mucosa, at most 10 mm; <= 0: no tissue, -depth is the gap [m]
  Bite bite;         ///< where the thread would be; empty without tissue
};

/// @param begin, end  of the needle's path, in world [m]
NeedleReach reachOfNeedle(const Model& model, const State& state, const Eigen::Vector3d& begin,
                          const Eigen::Vector3d& end);

}  // namespace vibe
