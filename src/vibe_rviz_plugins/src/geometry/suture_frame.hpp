#pragma once
#include <Eigen/Core>

#include "geometry/suture_scene.hpp"

namespace vibe {

// Directions in which the parts of a suture lie, from the places of its bites and thread alone. All are unit vectors,
// turn with the suture, and are defined for every set, also when all its bites lie in one place.

/// Of the plane nearest to the bites; where they lie on a line, at right angles to it.
Eigen::Vector3d planeNormal(const SutureSet& set);

/// Of a ring around a bite: out of the wall if its side is known, so that the ring lies flat on it; else that of the
/// thread, the mean of the ways there and on.
Eigen::Vector3d biteAxis(const SutureSet& set, std::size_t bite);

/// Along the T-tag: it lies across the thread that holds it, flat on the wall.
Eigen::Vector3d tagAxis(const SutureSet& set);

/// Along the cinch: the thread runs through it.
Eigen::Vector3d cinchAxis(const SutureSet& set);

}  // namespace vibe
