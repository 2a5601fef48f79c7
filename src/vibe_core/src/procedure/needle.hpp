#pragma once
#include <Eigen/Geometry>
#include <utility>
#include <vector>

#include "procedure/needle_path.hpp"
#include "vibe_core/geometry/surface_view.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

/// From where to where the needle's point goes into tissue as the arm closes, in world [m]: the last 70 % of the chord
/// from its open to its closed place. Before that it swings free of the cap.
/// @param link_poses  in world; only that of the link which carries the needle is used
std::pair<Eigen::Vector3d, Eigen::Vector3d> needlePath(const Model& model,
                                                       const std::vector<Eigen::Isometry3d>& link_poses);

/// What the needle meets on its path through the deformed wall.
struct NeedleReach {
  double depth = 0;  ///< below the mucosa at its deepest, at most 10 mm; <= 0: no tissue, -depth is the gap [m]
  Bite bite;         ///< where the thread would go; empty without tissue
};

/// @param begin, end  of the needle's path, in world [m]
NeedleReach reachOfNeedle(const Model& model, const State& state, const Eigen::Vector3d& begin,
                          const Eigen::Vector3d& end);

/// The particles around a place of the wall, with weights that fall smoothly to 0 at `radius`: area at rest times
/// (1 - (d / radius)^2)^2. Only the sheet of wall that is connected to the place counts, not a wall opposite to it.
/// The corners of the triangle take part always: where the mesh is coarse the radius grows to 1.5 times their distance.
/// @param point  on `triangle` [m]
Bite biteAround(const Model& model, const SurfaceView& wall, int triangle, const Eigen::Vector3d& point, double radius);

/// The particle of the bite that pulls most; -1 without particles.
int nearestParticle(const Bite& bite);

}  // namespace vibe
