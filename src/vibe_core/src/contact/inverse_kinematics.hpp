#pragma once
#include <Eigen/Dense>
#include <array>
#include <vector>

#include "vibe_core/contact/tool_model.hpp"

namespace vibe {

/// Damped least squares (Levenberg-Marquardt) for one target of the tip; see ToolModel::inverseKinematics.
class InverseKinematics {
 public:
  using Inputs = std::array<double, kJointCount>;

  InverseKinematics(const ToolModel& tool, const Eigen::Isometry3d& target);

  /// The solution found by descent from `start`. Only if it misses the target by more than a millimetre (or the
  /// equivalent in direction) are other turns and bends tried. One of these is chosen only if it at least halves the
  /// error, so that a tool that follows a moving target does not jump for a small gain.
  Inputs solve(const Inputs& start);

 private:
  static constexpr int kFree = kScopeJointCount;
  using Residual = Eigen::Matrix<double, 6, 1>;
  using Jacobian = Eigen::Matrix<double, 6, kFree>;
  using Step = Eigen::Matrix<double, kFree, 1>;

  Inputs descend(Inputs inputs, double& cost);
  Residual residual(const Inputs& inputs);
  Jacobian jacobian() const;
  Inputs moved(const Inputs& from, const Step& step) const;
  void holdAtLimits(const Inputs& inputs, const Step& gradient, Eigen::Matrix<double, kFree, kFree>& matrix,
                    Step& right) const;

  const ToolModel& tool_;
  Eigen::Vector3d target_position_;
  Eigen::Vector3d target_direction_;
  int tip_;
  std::vector<int> path_;                 // joints from the root to the tip that the first four inputs move
  std::vector<Eigen::Isometry3d> poses_;  // of the inputs last given to residual()
};

}  // namespace vibe
