#pragma once
#include <Eigen/Core>

#include "vibe_core/geometry/surface_view.hpp"

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

}  // namespace vibe
