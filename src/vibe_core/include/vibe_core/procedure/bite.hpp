#pragma once
#include <Eigen/Core>

#include "vibe_core/geometry/surface_view.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/suture/suture.hpp"

namespace vibe {

/// The particles around a point of the wall, with weights that fall smoothly to 0 at `radius`: area at rest times
/// (1 - (d / radius)^2)^2. Only wall that is connected to the point within the radius counts, not a wall opposite to
/// it. The corners of the triangle always take part: on a coarse mesh the radius grows to 1.5 times their distance.
/// @param point  on `triangle` [m]
Bite biteAround(const Model& model, const SurfaceView& wall, int triangle, const Eigen::Vector3d& point, double radius);

/// The particle of the bite with the largest weight; -1 without particles.
int nearestParticle(const Bite& bite);

}  // namespace vibe
