#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "contact/tool_guard.hpp"
#include "haptics/impedance_estimator.hpp"
#include "solver/sum_term.hpp"
#include "vibe_core/constraints/constraint_block.hpp"
#include "vibe_core/model/tissue_solver.hpp"
#include "vibe_core/solver/implicit_stepper.hpp"

namespace vibe {

/// Buffers of ImplicitSolver.
struct ImplicitWorkspace : SolverWorkspace {
  std::shared_ptr<StepperWorkspace> stepper;
  std::vector<std::unique_ptr<ConstraintBlock>> blocks;  // in the order in which they are asked
  BodyLoads loads;
  SumTerm terms;                                   // energies of the blocks
  std::array<std::vector<double>, 6> uncorrected;  // positions and velocities before corrections [m], [m/s]
  std::optional<ToolGuard> guard;                  // empty without a tool
  std::vector<int> held;                           // particles that the helix holds
  std::array<std::vector<double>, 3> start;        // positions at the start of the step [m]
  std::vector<ToolTouch> touches;                  // of the last step
  std::unique_ptr<ImpedanceEstimator> impedance;   // null without a tool
  ToolContactRows tool_rows;
};

}  // namespace vibe
