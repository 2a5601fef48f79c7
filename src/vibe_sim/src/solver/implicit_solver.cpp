#include "vibe_sim/solver/implicit_solver.hpp"

#include <algorithm>

#include "implicit_step.hpp"

namespace vibe {

ImplicitSolver::ImplicitSolver(std::shared_ptr<const ShellElements> shell, ElasticBody body, StepSettings settings)
    : shell_(std::move(shell)), stepper_(std::move(body), settings) {}

std::unique_ptr<SolverScratch> ImplicitSolver::makeScratch(const Model& model) const {
  auto scratch = std::make_unique<ImplicitScratch>();
  scratch->stepper = stepper_.makeScratch();
  for (auto* v : {&scratch->ahead_x, &scratch->ahead_y, &scratch->ahead_z})
    v->resize(static_cast<std::size_t>(model.particle_count));
  if (model.tool) scratch->collision = std::make_unique<ToolCollision>(*model.tool);
  return scratch;
}

void ImplicitSolver::advance(const Model& model, const ToolMotion* motion, bool insufflator_on, State& state,
                             Workspace& workspace, StepReport& report) const {
  ImplicitStep(model, stepper_, motion, insufflator_on, state, workspace, report).run();
}

}  // namespace vibe
