#pragma once

#include <memory>
#include <string>

#include "dynamics/loss_limits.hpp"
#include "vibe_core/model/tissue_solver.hpp"
#include "vibe_core/solver/implicit_stepper.hpp"

namespace vibe {

class ShellElements;

/// Advances the tissue of a scene by implicit steps: one step of ImplicitStepper per step of the simulator. What acts
/// on the tissue comes from constraint blocks, see constraint_registry.hpp.
class ImplicitSolver : public Solver {
 public:
  /// @param shell  the wall, on the particles
  ImplicitSolver(std::shared_ptr<const ShellElements> shell, ElasticBody body, StepSettings settings);

  std::string name() const override { return "implicit"; }
  std::unique_ptr<SolverWorkspace> makeWorkspace(const Model& model) const override;
  void advance(const Model& model, const ToolMotion* motion, bool insufflator_on, State& state,
               SolverWorkspace& scratch, ThreadPool& pool, StepReport& report) const override;

 private:
  std::shared_ptr<const ShellElements> shell_;
  ImplicitStepper stepper_;
  LossLimits limits_;
};

}  // namespace vibe
