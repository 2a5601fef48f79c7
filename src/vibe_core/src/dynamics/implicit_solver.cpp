#include "dynamics/implicit_solver.hpp"

#include <algorithm>

#include "contact/surface_contacts.hpp"
#include "dynamics/implicit_step.hpp"
#include "vibe_core/constraints/constraint_registry.hpp"
#include "vibe_core/tissue/shell.hpp"

namespace vibe {

ImplicitSolver::ImplicitSolver(std::shared_ptr<const ShellElements> shell, ElasticBody body, StepSettings settings)
    : shell_(std::move(shell)), stepper_(std::move(body), settings), limits_(*shell_, stepper_.body().rest) {}

std::unique_ptr<SolverWorkspace> ImplicitSolver::makeWorkspace(const Model& model) const {
  auto scratch = std::make_unique<ImplicitWorkspace>();
  scratch->stepper = stepper_.makeWorkspace();
  scratch->blocks = makeConstraintBlocks(model);
  if (model.tool)
    scratch->guard.emplace(*model.tool, model.organ.surface, model.organ.thickness, passableVertices(model.organ));
  if (model.tool) scratch->impedance = std::make_unique<ImpedanceEstimator>(stepper_.body(), model.scene.step_period);
  return scratch;
}

void ImplicitSolver::advance(const Model& model, const ToolMotion* motion, bool insufflator_on, State& state,
                             SolverWorkspace& scratch, ThreadPool&, StepReport& report) const {
  ImplicitStep(model, stepper_, limits_, motion, insufflator_on, state, static_cast<ImplicitWorkspace&>(scratch),
               report)
      .run();
}

}  // namespace vibe
