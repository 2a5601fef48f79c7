#pragma once
#include <Eigen/Core>
#include <array>

#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

/// A place of the wall as a trainee aims at it.
struct WallPlace {
  Eigen::Vector3d point;    ///< in world [m]
  Eigen::Vector3d outward;  ///< out of the lumen, unit
};

/// Where a particle is now, with the wall's direction around it.
WallPlace placeOf(const Model& model, const State& state, int particle);

/// The particle at a place that anatomy names: `along` the organ's axis (0: apex of the fundus, 1: pylorus), at an
/// angle around it from the greater curvature [rad]: positive anterior, negative posterior. At rest.
int particleAt(const Model& model, double along, double angle);

/// Joints that bring a point of the scope's tip to a place, looking along a direction as well as its four joints can.
struct IkSolution {
  std::array<double, kJointCount> joints;
  double miss = 0;  ///< distance that is left [m]
  double turn = 0;  ///< angle between the tip's axis and the asked direction [rad]
};
/// @param offset  of the point, in scope_tip [m]
/// @param start   present joints; those that are not of the scope are kept
IkSolution aimAt(const Model& model, const Eigen::Vector3d& point, const Eigen::Vector3d& direction,
                 const Eigen::Vector3d& offset, const std::array<double, kJointCount>& start);

}  // namespace vibe
