#include "solver/stepper_workspace.hpp"

#include <utility>

namespace vibe {

StepperWorkspace::StepperWorkspace(const std::vector<Eigen::Vector3d>& rest_positions,
                                   std::shared_ptr<const FactorPlan> elements_plan, FactorStorage storage,
                                   std::shared_ptr<const BlockPattern> pattern)
    : plan(std::move(elements_plan)),
      factor(std::make_unique<Factor>(plan, storage)),
      next_factor(std::make_unique<Factor>(plan, storage)),
      matrix(std::move(pattern)) {
  const std::size_t size = 4 * rest_positions.size();
  for (auto* v : {&rest, &z, &z_hat, &trial}) v->assign(size, 0);
  for (auto* v : {&gradient, &trial_gradient, &direction, &work}) v->assign(size, 0);
  for (Evaluation* e : {&last, &first, &kept})
    for (auto* v : {&e->displacement, &e->elastic_gradient, &e->extra_gradient, &e->volume_gradient})
      v->assign(size, 0);
  for (std::size_t i = 0; i < rest_positions.size(); ++i)
    for (int k = 0; k < 3; ++k) rest[4 * i + k] = rest_positions[i][k];
  half.assign(3 * rest_positions.size() + 16, 0);
  move.assign(kHistory, std::vector<float>(size));
  change.assign(kHistory, std::vector<float>(size));
  curvature.assign(kHistory, 0);
}

StepperWorkspace::~StepperWorkspace() {
  making.reset();  // it works on the other members
}

}  // namespace vibe
