#pragma once
#include <Eigen/Geometry>
#include <utility>
#include <vector>

#include "procedure/needle_path.hpp"
#include "vibe_core/geometry/surface_view.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/procedure/bite.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

/// Path of the needle's point through tissue as the arm closes, in world [m]: the last 70 % of the chord from its open
/// to its closed position. Before that the needle moves outside of the cap.
/// @param link_poses  of the tool's links in world; only that of the needle's link is used
/// @return begin and end
std::pair<Eigen::Vector3d, Eigen::Vector3d> needlePath(const Model& model,
                                                       const std::vector<Eigen::Isometry3d>& link_poses);

/// How far the needle reaches into the deformed wall.
struct NeedleReach {
  double depth = 0;  ///< greatest depth below the mucosa, at most 10 mm; <= 0: no tissue, -depth is the gap [m]
  Bite bite;         ///< where the thread would be; empty without tissue
};

/// @param begin, end  of the needle's path, in world [m]
NeedleReach reachOfNeedle(const Model& model, const State& state, const Eigen::Vector3d& begin,
                          const Eigen::Vector3d& end);

}  // namespace vibe
