#include "dynamics/implicit_solver.hpp"

#include "dynamics/implicit_step.hpp"
#include "dynamics/implicit_workspace.hpp"
#include "solver/stepper_workspace.hpp"
#include "tool_contact/surface_contacts.hpp"
#include "vibe_core/model/model.hpp"
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
  if (model.tool)
    scratch->impedance =
        std::make_unique<ImpedanceEstimator>(stepper_.body(), model.scene.step_period, restStiffness());
  return scratch;
}

const RestStiffness& ImplicitSolver::restStiffness() const {
  std::call_once(rest_asked_, [this] { rest_ = std::make_unique<const RestStiffness>(stepper_.body()); });
  return *rest_;
}

void ImplicitSolver::advance(const Model& model, const ToolMotion* motion, bool insufflator_on, State& state,
                             SolverWorkspace& scratch, ThreadPool& pool, StepReport& report) const {
  auto& own = static_cast<ImplicitWorkspace&>(scratch);
  own.stepper->stages = own.stages;
  own.stepper->use(pool, stepper_.body().shell);
  ImplicitStep(model, stepper_, limits_, motion, insufflator_on, state, own, report).run();
}

std::shared_ptr<const void> ImplicitSolver::prepare(const State& state, SolverWorkspace& scratch) const {
  return stepper_.shareFactor(state.solver, *static_cast<ImplicitWorkspace&>(scratch).stepper);
}

}  // namespace vibe
