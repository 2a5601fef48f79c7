#include "dynamics/implicit_solver.hpp"

#include <algorithm>

#include "contact/surface_contacts.hpp"
#include "dynamics/implicit_step.hpp"
#include "tissue/shell.hpp"
#include "vibe_core/constraints/constraint_registry.hpp"

namespace vibe {

ImplicitSolver::ImplicitSolver(std::shared_ptr<const ShellElements> shell, ElasticBody body, StepSettings settings)
    : shell_(std::move(shell)), stepper_(std::move(body), settings) {
  // a tenth of what it takes to make the whole organ twice as large
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  const std::vector<Eigen::Vector3d>& rest = stepper_.body().rest;
  for (const Eigen::Vector3d& p : rest) centre += p / static_cast<double>(rest.size());
  std::vector<double> swollen;
  for (const Eigen::Vector3d& p : rest)
    for (int k = 0; k < 3; ++k) swollen.push_back(p[k] - centre[k]);
  std::vector<double> gradient(swollen.size());
  absurd_energy_ = 0.1 * shell_->evaluate(swollen.data(), gradient.data());
}

std::unique_ptr<SolverScratch> ImplicitSolver::makeScratch(const Model& model) const {
  auto scratch = std::make_unique<ImplicitScratch>();
  scratch->stepper = stepper_.makeScratch();
  scratch->blocks = makeConstraintBlocks(model);
  if (model.tool)
    scratch->guard.emplace(*model.tool, model.organ.surface, model.organ.thickness, passableVertices(model.organ));
  if (model.tool) scratch->impedance = std::make_unique<ImpedanceEstimator>(stepper_.body(), model.scene.step_period);
  return scratch;
}

void ImplicitSolver::advance(const Model& model, const ToolMotion* motion, bool insufflator_on, State& state,
                             SolverScratch& scratch, ThreadPool&, StepReport& report) const {
  ImplicitStep(model, stepper_, absurd_energy_, motion, insufflator_on, state, static_cast<ImplicitScratch&>(scratch),
               report)
      .run();
}

}  // namespace vibe
