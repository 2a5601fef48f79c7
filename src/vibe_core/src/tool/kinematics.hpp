#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "tool/tip_chain.hpp"
#include "vibe_core/tool/tool_model.hpp"

namespace vibe {

/// The joint of that name, null without one.
const ToolJoint* findJoint(const ToolModel& tool, const std::string& name);

/// Two bars that are joined by a pin: one turns about the hinge of the needle arm, the other about the needle's point.
struct LinkageTurns {
  double arm = 0;   ///< about needle_arm_hinge, 0 with the arm open [rad]
  double hook = 0;  ///< about needle_hook_turn, 0 with the arm open [rad]
};

/// The turns with which needle_arm_pin and needle_hook_pin are at the same point while needle_driver slides: two
/// circles meet there, on the side on which they meet with the arm open. Where they do not meet, the bars point at each
/// other.
/// @param driver  position of needle_driver [m]
/// @return empty if the URDF has no such bars, or if arm and needle are not carried by the same link
std::optional<LinkageTurns> needleLinkage(const ToolModel& tool, double driver);

/// Damped least squares (Levenberg-Marquardt) for targets of the tip; see ToolModel::inverseKinematics.
class InverseKinematics {
 public:
  using Inputs = TipChain::Inputs;

  /// @param tool  outlives this
  explicit InverseKinematics(const ToolModel& tool);

  /// The solution found by descent from `start`. Only if it misses the target by more than a millimetre (or the
  /// equivalent in direction) are other turns and bends tried. One of these is chosen only if it at least halves the
  /// error, so that a tool that follows a moving target does not jump for a small gain.
  /// @param target  pose of scope_tip in the root frame
  Inputs solve(const Eigen::Isometry3d& target, const Inputs& start);
  /// The solution found by descent from `start` alone.
  Inputs follow(const Eigen::Isometry3d& target, const Inputs& start);
  /// Where scope_tip is, in the root frame.
  const Eigen::Isometry3d& place(const Inputs& inputs) { return chain_.place(inputs); }

 private:
  static constexpr int kFree = kScopeJointCount;
  using Residual = Eigen::Matrix<double, 6, 1>;
  using Jacobian = Eigen::Matrix<double, 6, kFree>;
  using Step = Eigen::Matrix<double, kFree, 1>;

  struct Descent {
    Inputs inputs;
    Residual residual;
    double cost, damping;  // square of the residual [m^2]; ratio
  };

  void aim(const Eigen::Isometry3d& target);
  Inputs descend(const Inputs& start, double& cost);
  bool improve(Descent& at);
  Residual residual(const Inputs& inputs);
  Jacobian jacobian() const;
  Inputs moved(const Inputs& from, const Step& step) const;
  void holdAtLimits(const Inputs& inputs, const Step& gradient, Eigen::Matrix<double, kFree, kFree>& matrix,
                    Step& right) const;

  const ToolModel& tool_;
  TipChain chain_;  // at the inputs last tried
  Eigen::Vector3d target_position_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d target_direction_ = Eigen::Vector3d::UnitX();
};

}  // namespace vibe
