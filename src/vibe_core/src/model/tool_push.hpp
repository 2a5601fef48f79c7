#pragma once

#include <Eigen/Geometry>

#include "vibe_core/model/tissue_solver.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

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
