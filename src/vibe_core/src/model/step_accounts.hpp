#pragma once

#include <algorithm>
#include <cstddef>

#include <Eigen/Geometry>

#include "vibe_core/model/tissue_solver.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

/// The square of the largest speed of a particle [m^2/s^2].
inline double maxSpeedSquared(const State& state) {
  const double *vx = state.vx.data(), *vy = state.vy.data(), *vz = state.vz.data();
  double max = 0;
  for (std::size_t i = 0; i < state.vx.size(); ++i) max = std::max(max, vx[i] * vx[i] + vy[i] * vy[i] + vz[i] * vz[i]);
  return max;
}

/// Adds one force of the tissue on the tool to the report, and its work to the account of the state.
/// @param force   on the tool [N]
/// @param at      where, world [m]
/// @param motion  of the tool at this point [m]
/// @param tip     origin of scope_tip, about which the torque is taken, world [m]
inline void pushTool(const Eigen::Vector3d& force, const Eigen::Vector3d& at, const Eigen::Vector3d& motion,
                     const Eigen::Vector3d& tip, StepReport& report, EnergyAccount& energy) {
  report.tool_force += force;
  report.tool_torque += (at - tip).cross(force);
  energy.tool_work -= force.dot(motion);
}

}  // namespace vibe
