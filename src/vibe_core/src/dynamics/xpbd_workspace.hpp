#pragma once
#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "constraints/xpbd_pull.hpp"
#include "contact/tool_collision.hpp"
#include "tissue/shape_matching.hpp"
#include "tissue/shape_matching_kernel.hpp"
#include "vibe_core/constraints/constraint_block.hpp"
#include "vibe_core/model/tissue_solver.hpp"

namespace vibe {

/// Buffers of XpbdSolver.
class XpbdWorkspace : public SolverWorkspace {
 public:
  std::vector<double> old_x, old_y, old_z;        // positions before the sub-step [m]
  std::vector<double> ahead_x, ahead_y, ahead_z;  // positions a little ahead, where elastic forces are taken [m]
  std::vector<double> foundation_rate;  // stiffness of each particle's piece of foundation over its mass [1/s^2]
  SweepBuffers buffers;
  ClusterSweep sweep{};
  ClusterSweepFunction sweep_function = nullptr;
  std::unique_ptr<ToolCollision> collision;
  XpbdPull pull;
  std::vector<std::unique_ptr<ConstraintBlock>> added;  // each with a substepLoad()
  LinkPoses old_tool, tool_ahead;                       // before the sub-step, after the last one until the next search
};

}  // namespace vibe
