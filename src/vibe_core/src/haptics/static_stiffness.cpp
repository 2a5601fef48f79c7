#include "haptics/static_stiffness.hpp"

#include <algorithm>

#include "sparse/factor_plan.hpp"
#include "vibe_core/solver/step_policy.hpp"

namespace vibe {

RestStiffness::RestStiffness(const ElasticBody& body)
    : plan(makeFactorPlan(blockPattern(body.nodeCount(), body.elements->nodeGroups()))) {
  StaticStiffness::Own own(plan);
  if (own.make(body, {})) factor = own.factor;
}

StaticStiffness::Own::Own(const std::shared_ptr<const FactorPlan>& plan)
    : matrix(plan->pattern), factor(std::make_shared<Factor>(plan, FactorStorage::Float)) {}

bool StaticStiffness::Own::make(const ElasticBody& body, const std::vector<float>& positions) {
  displacement.assign(3 * body.rest.size(), 0.0);
  if (!positions.empty())
    for (std::size_t i = 0; i < displacement.size(); ++i)
      displacement[i] = static_cast<double>(positions[i]) - body.rest[i / 3][static_cast<Eigen::Index>(i % 3)];
  matrix.setZero();
  body.elements->addStiffness(displacement.data(), matrix);
  for (int i = 0; i < body.nodeCount(); ++i) {
    // A free body has a singular stiffness, so each mass is on a weak spring.
    const double spring =
        stepPolicy().haptic_mass_spring * body.mass[i] + (body.foundation.empty() ? 0 : body.foundation[i]);
    matrix.add(i, i, spring * Eigen::Matrix3d::Identity());
  }
  for (int i = 0; i < body.nodeCount(); ++i)
    if (body.fixed[i] != 0) matrix.fix(i);
  return factor->compute(matrix);
}

StaticStiffness::StaticStiffness(const ElasticBody& body, const RestStiffness& rest)
    : body_(body), plan_(rest.plan), factor_(rest.factor) {
  half_.resize(3 * body.rest.size() + 16);
  if (factor_) schur_.reset(*factor_);
}

bool StaticStiffness::make(const std::vector<float>& positions) {
  if (!own_) own_ = std::make_unique<Own>(plan_);
  if (!own_->make(body_, positions)) return false;
  factor_ = own_->factor;
  columns_.reset();
  schur_.reset(*factor_);
  return true;
}

void StaticStiffness::setGas(const std::vector<float>& direction4, double stiffness) {
  schur_.setGas(direction4.data(), stiffness, *factor_);
}

void StaticStiffness::setRows(const ConstraintRows& rows) {
  schur_.setRows(rows, *factor_, columns_);
}

void StaticStiffness::prepare(const std::vector<int>& nodes) {
  columns_.prepare(*factor_, nodes, {});
}

Eigen::MatrixXd StaticStiffness::movingMass(const Eigen::MatrixXd& motion) {
  const auto modes = static_cast<int>(motion.cols());
  std::vector<std::vector<float>> shape(modes, std::vector<float>(4 * body_.rest.size()));
  for (int c = 0; c < modes; ++c) {
    std::fill(half_.begin(), half_.end(), 0.0F);
    schur_.eliminate(motion.col(c), 0, half_.data());
    factor_->backward(half_.data());
    factor_->store(half_.data(), shape[c].data());
  }
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(modes, modes);
  for (int a = 0; a < modes; ++a)
    for (int b = 0; b <= a; ++b) {
      for (int i = 0; i < body_.nodeCount(); ++i)
        if (body_.fixed[i] == 0)
          for (int k = 0; k < 3; ++k)
            mass(a, b) += body_.mass[i] * static_cast<double>(shape[a][4 * i + k]) * shape[b][4 * i + k];
      mass(b, a) = mass(a, b);
    }
  return mass;
}

}  // namespace vibe
