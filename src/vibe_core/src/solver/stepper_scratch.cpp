#include "solver/stepper_scratch.hpp"

#include <utility>

namespace vibe {

StepperScratch::StepperScratch(const std::vector<Eigen::Vector3d>& rest_positions,
                               std::shared_ptr<const FactorPlan> elements_plan, FactorStorage storage,
                               std::shared_ptr<const BlockPattern> pattern)
    : plan(std::move(elements_plan)),
      factor(std::make_unique<Factor>(plan, storage)),
      next_factor(std::make_unique<Factor>(plan, storage)),
      matrix(std::move(pattern)) {
  const std::size_t size = 4 * rest_positions.size();
  for (auto* v : {&rest, &z, &z_hat, &trial}) v->assign(size, 0);
  for (auto* v : {&displacement, &gradient, &trial_gradient, &volume_gradient, &direction, &work, &elastic_gradient,
                  &extra_gradient, &first_displacement, &first_elastic_gradient, &first_extra_gradient,
                  &kept_displacement_, &kept_elastic_gradient_, &kept_extra_gradient_, &kept_volume_gradient_})
    v->assign(size, 0);
  for (std::size_t i = 0; i < rest_positions.size(); ++i)
    for (int k = 0; k < 3; ++k) rest[4 * i + k] = rest_positions[i][k];
  half.assign(3 * rest_positions.size() + 16, 0);
  move.assign(kHistory, std::vector<float>(size));
  change.assign(kHistory, std::vector<float>(size));
  curvature.assign(kHistory, 0);
}

StepperScratch::~StepperScratch() {
  making.reset();  // it works on the other members
}

void StepperScratch::exchangeEvaluations() {
  displacement.swap(kept_displacement_);
  elastic_gradient.swap(kept_elastic_gradient_);
  extra_gradient.swap(kept_extra_gradient_);
  volume_gradient.swap(kept_volume_gradient_);
  std::swap(elastic_value, kept_elastic_value_);
  std::swap(volume, kept_volume_);
  std::swap(pressure, kept_pressure_);
  std::swap(only_first, kept_only_first_);
}

}  // namespace vibe
