#pragma once
#include <vector>

#include "geometry/wall_surface.hpp"

namespace vibe::rviz_plugins {

/// Where something that flows slowly runs on a wall: the line of steepest descent of its smooth normals, in steps of
/// 1.2 mm or less. It ends where the wall goes down no more (a hollow, or the tip of a fold that hangs down), or after
/// 400 steps. The same wall and start give the same line.
/// @param down  direction of gravity, unit
/// @return  from the start on; at least the start
std::vector<WallPlace> steepestDescent(const WallSurface& wall, const WallPlace& start, const Eigen::Vector3d& down);

/// The vertex that is reached from a point by going to the lowest neighbour until there is none: the bottom of a
/// hollow.
std::uint32_t bottomBelow(const WallSurface& wall, const WallPlace& point, const Eigen::Vector3d& down);
std::uint32_t bottomBelow(const WallSurface& wall, std::uint32_t vertex, const Eigen::Vector3d& down);

}  // namespace vibe::rviz_plugins
