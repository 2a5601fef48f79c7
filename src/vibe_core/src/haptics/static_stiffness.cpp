#include "haptics/static_stiffness.hpp"

#include <algorithm>

namespace vibe {

namespace {

// A free body has a singular stiffness, so each mass is on a weak spring: stiffness per mass [1/s^2]. The slowest modes
// of organs are above 10 rad/s, so this is below a hundredth of any stiffness there.
constexpr double kMinSpring = 1;

}  // namespace

StaticStiffness::StaticStiffness(const ElasticBody& body, std::shared_ptr<const BlockPattern> pattern,
                                 std::shared_ptr<const FactorPlan> plan)
    : body_(body), matrix_(std::move(pattern)), factor_(std::move(plan), FactorStorage::Float) {
  displacement_.resize(3 * body.rest.size());
  half_.resize(3 * body.rest.size() + 16);
}

bool StaticStiffness::make(const std::vector<float>& positions) {
  std::fill(displacement_.begin(), displacement_.end(), 0.0);
  if (!positions.empty())
    for (std::size_t i = 0; i < displacement_.size(); ++i)
      displacement_[i] = static_cast<double>(positions[i]) - body_.rest[i / 3][static_cast<Eigen::Index>(i % 3)];
  matrix_.setZero();
  body_.elements->addStiffness(displacement_.data(), matrix_);
  for (int i = 0; i < body_.nodeCount(); ++i) {
    const double spring = kMinSpring * body_.mass[i] + (body_.foundation.empty() ? 0 : body_.foundation[i]);
    matrix_.add(i, i, spring * Eigen::Matrix3d::Identity());
  }
  for (int i = 0; i < body_.nodeCount(); ++i)
    if (body_.fixed[i] != 0) matrix_.fix(i);
  if (!factor_.compute(matrix_)) return false;
  columns_.reset();
  schur_.reset(factor_);
  return true;
}

void StaticStiffness::setGas(const std::vector<float>& direction4, double stiffness) {
  schur_.setGas(direction4.data(), stiffness, factor_);
}

void StaticStiffness::setRows(const ConstraintRows& rows) {
  schur_.setRows(rows, factor_, columns_);
}

Eigen::MatrixXd StaticStiffness::movingMass(const Eigen::MatrixXd& motion) {
  const auto modes = static_cast<int>(motion.cols());
  std::vector<std::vector<float>> shape(modes, std::vector<float>(4 * body_.rest.size()));
  for (int c = 0; c < modes; ++c) {
    std::fill(half_.begin(), half_.end(), 0.0F);
    schur_.eliminate(motion.col(c), 0, half_.data());
    factor_.backward(half_.data());
    factor_.store(half_.data(), shape[c].data());
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
