#include "solver/stepper_workspace.hpp"

#include <utility>

namespace vibe {

StepperWorkspace::StepperWorkspace(const std::vector<Eigen::Vector3d>& rest_positions,
                                   std::shared_ptr<const FactorPlan> elements_plan, FactorStorage storage,
                                   std::shared_ptr<const BlockPattern> pattern, std::shared_ptr<FactorShelf> shelf)
    : factors(std::move(elements_plan), storage, std::move(pattern), std::move(shelf)) {
  const std::size_t size = 4 * rest_positions.size();
  Iterate& i = iterate;
  for (auto* v : {&rest, &moves, &i.z, &i.z_hat, &i.trial}) v->assign(size, 0);
  for (auto* v : {&i.gradient, &i.trial_gradient, &i.direction, &i.work}) v->assign(size, 0);
  for (Evaluation* e : {&i.last, &i.first, &i.kept})
    for (auto* v : {&e->displacement, &e->elastic_gradient, &e->extra_gradient, &e->volume_gradient})
      v->assign(size, 0);
  for (std::size_t n = 0; n < rest_positions.size(); ++n)
    for (int k = 0; k < 3; ++k) rest[4 * n + k] = rest_positions[n][k];
  i.half.assign(3 * rest_positions.size() + 16, 0);
  history.move.assign(PairHistory::kSize, std::vector<float>(size));
  history.change.assign(PairHistory::kSize, std::vector<float>(size));
  history.curvature.assign(PairHistory::kSize, 0);
}

void StepperWorkspace::contract(const std::vector<float>* contraction) {
  if (contraction == nullptr && !contracted) return;
  contracted = contraction != nullptr;
  for (std::size_t n = 0; 4 * n < rest.size(); ++n)
    rest[4 * n + 3] = contracted ? -static_cast<double>((*contraction)[n]) : 0;
}

void StepperWorkspace::use(ThreadPool& threads, const ShellElements* shell) {
  pool = &threads;
  system.schur.use(threads);
  if (shared.threads == threads.threads()) return;
  factors.share(threads.threads());
  shared.divide(shell, threads.threads());
}

}  // namespace vibe
