#include "input/tip_velocity.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

namespace vibe::sim {
namespace {

constexpr double kDifference = 1e-6;    // of a joint, for the Jacobian [m], [rad]
constexpr double kPlaceDamping = 1e-8;  // of squares of singular values [m^2]: a motion of 0.1 mm per unit is none
constexpr double kTurnDamping = 1e-3;   // [rad^2]

using Jacobian = Eigen::Matrix<double, 6, kScopeJointCount>;

Eigen::Isometry3d tipAt(const Model& model, const JointArray& joints, std::vector<Eigen::Isometry3d>& poses) {
  model.tool->forwardKinematics(joints, poses);
  return model.tool_base * poses[static_cast<std::size_t>(model.tip_link)];
}

/// Linear and angular velocity of the tip in world per velocity of each joint.
Jacobian jacobianAt(const Model& model, const JointArray& joints) {
  std::vector<Eigen::Isometry3d> poses;
  Jacobian jacobian;
  for (int j = 0; j < kScopeJointCount; ++j) {
    JointArray after = joints, before = joints;
    after[static_cast<std::size_t>(j)] += kDifference;
    before[static_cast<std::size_t>(j)] -= kDifference;
    const Eigen::Isometry3d a = tipAt(model, after, poses), b = tipAt(model, before, poses);
    const Eigen::Matrix3d turn = a.linear() * b.linear().transpose();
    jacobian.col(j).head<3>() = (a.translation() - b.translation()) / (2 * kDifference);
    jacobian.col(j).tail<3>() =
        Eigen::Vector3d(turn(2, 1) - turn(1, 2), turn(0, 2) - turn(2, 0), turn(1, 0) - turn(0, 1)) / (4 * kDifference);
  }
  return jacobian;
}

/// Damped pseudoinverse.
template <typename Matrix>
Eigen::Matrix<double, kScopeJointCount, 3> inverseOf(const Matrix& matrix, double damping) {
  const Eigen::Matrix3d square = matrix * matrix.transpose() + damping * Eigen::Matrix3d::Identity();
  return matrix.transpose() * square.inverse();
}

}  // namespace

JointArray afterTwist(const Model& model, const JointArray& joints, const Eigen::Matrix<double, 6, 1>& twist,
                      double dt) {
  using Rates = Eigen::Matrix<double, kScopeJointCount, 1>;
  const Jacobian jacobian = jacobianAt(model, joints);
  const Eigen::Matrix<double, 3, kScopeJointCount> place = jacobian.topRows<3>(), turn = jacobian.bottomRows<3>();
  const auto inverse = inverseOf(place, kPlaceDamping);
  Rates rates = inverse * twist.head<3>();
  const Eigen::Matrix<double, kScopeJointCount, kScopeJointCount> rest =
      Eigen::Matrix<double, kScopeJointCount, kScopeJointCount>::Identity() - inverse * place;
  const Eigen::Matrix<double, 3, kScopeJointCount> free_turn = turn * rest;
  rates += inverseOf(free_turn, kTurnDamping) * (twist.tail<3>() - turn * rates);

  double slowed = 1;
  const auto& limits = model.tool->limits();
  for (std::size_t j = 0; j < kScopeJointCount; ++j)
    slowed = std::min(slowed, limits[j].velocity / std::max(std::abs(rates[static_cast<int>(j)]), 1e-12));
  JointArray result = joints;
  for (std::size_t j = 0; j < kScopeJointCount; ++j)
    result[j] = std::clamp(joints[j] + slowed * dt * rates[static_cast<int>(j)], limits[j].lower, limits[j].upper);
  return result;
}

}  // namespace vibe::sim
