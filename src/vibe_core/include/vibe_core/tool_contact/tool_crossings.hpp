#pragma once
#include <Eigen/Geometry>
#include <vector>

#include "vibe_core/geometry/surface_mesh.hpp"
#include "vibe_core/tool/tool_model.hpp"

namespace vibe {

/// How far a tool and a wall pass through each other.
struct ToolCrossing {
  int pierced = 0;    ///< pairs of a triangle and a shape whose core passes through it
  double depth = 0;   ///< largest distance of a point of the wall below the surface of a shape; 0: all outside [m]
  int shape = -1;     ///< where it is: index in ToolModel::shapes(), -1: nowhere
  int triangle = -1;  ///< likewise
};

/// Tries all triangles against all shapes of the tool. The core of a capsule or cylinder is its axis, of a box the
/// three lines between the middles of opposite faces, of a sphere nothing. Depths in capsules and spheres are exact; in
/// boxes and cylinders they are those of points of the triangle at distances of a sixteenth of its edges. It is meant
/// to check the simulation from outside and shares nothing with its contact.
/// @param link_poses  of the tool, in world
/// @param wall        its middle surface, in world
/// @param passes      triangles with such a vertex do not count, for ends that are open; (vertices), or empty
ToolCrossing findToolCrossing(const ToolModel& tool, const std::vector<Eigen::Isometry3d>& link_poses,
                              const SurfaceView& wall, const std::vector<char>& passes);

}  // namespace vibe
