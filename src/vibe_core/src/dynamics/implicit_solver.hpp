#pragma once

#include <memory>
#include <mutex>
#include <string>

#include "dynamics/loss_limits.hpp"
#include "haptics/impedance_estimator.hpp"
#include "vibe_core/model/tissue_solver.hpp"
#include "vibe_core/solver/elastic_body.hpp"
#include "vibe_core/solver/implicit_stepper.hpp"

namespace vibe {

class ShellElements;

/// Advances the tissue of a scene by implicit steps: one ImplicitStep per step of the simulator. What acts on the
/// tissue comes from constraint blocks, see constraint_registry.hpp.
class ImplicitSolver : public Solver {
 public:
  /// @param shell  the wall, on the particles
  ImplicitSolver(std::shared_ptr<const ShellElements> shell, ElasticBody body, StepSettings settings);

  std::string name() const override { return "implicit"; }
  std::unique_ptr<SolverWorkspace> makeWorkspace(const Model& model) const override;
  void advance(const Model& model, const ToolMotion* motion, bool insufflator_on, State& state,
               SolverWorkspace& scratch, ThreadPool& pool, StepReport& report) const override;
  std::shared_ptr<const void> prepare(const State& state, SolverWorkspace& scratch) const override;

 private:
  std::shared_ptr<const ShellElements> shell_;
  ImplicitStepper stepper_;
  LossLimits limits_;
  mutable std::once_flag rest_asked_;
  mutable std::unique_ptr<const RestStiffness> rest_;  // of all workspaces; made with the first one

  const RestStiffness& restStiffness() const;
};

}  // namespace vibe
