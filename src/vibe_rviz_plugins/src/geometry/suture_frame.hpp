#pragma once
#include <Eigen/Core>

#include "geometry/suture_drawing.hpp"

namespace vibe::rviz_plugins {

// Orientation of the parts of a suture from the positions of its bites and thread. All are unit vectors, rotate with
// the suture, and are defined for every set, even if all bites coincide.

/// Normal of the plane that fits the bites best; perpendicular to the line if they are collinear.
Eigen::Vector3d planeNormal(const SutureSet& set);

/// Axis of the ring at a bite: normal to the wall if its side is known, so that the ring lies flat on it; otherwise the
/// mean direction of the thread before and after.
Eigen::Vector3d biteAxis(const SutureSet& set, std::size_t bite);

/// Axis of the T-tag, which lies flat on the wall across the thread.
Eigen::Vector3d tagAxis(const SutureSet& set);

/// Axis of the cinch, along the thread.
Eigen::Vector3d cinchAxis(const SutureSet& set);

}  // namespace vibe::rviz_plugins
