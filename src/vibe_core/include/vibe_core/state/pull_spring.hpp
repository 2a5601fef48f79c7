#pragma once
#include <Eigen/Core>
#include <vector>

namespace vibe {

constexpr double kPullStiffness = 300;  ///< of the spring between patch and target [N/m]
constexpr double kPullForce = 5;        ///< the target stays so near that the spring pulls no harder [N]
constexpr double kPullSpeed = 0.25;     ///< of the target at most, so that a jump of the mouse tears nothing [m/s]
constexpr double kPullRadius = 6e-3;    ///< of the patch around the particle, at rest [m]

/// A hand that pulls the tissue at one place: a spring from the weighted mean of a patch of the wall to a target that
/// follows StepInput::pull_target.
struct PullSpring {
  int particle = -1;                                 ///< about which the patch lies; -1: nothing is held
  std::vector<int> node;                             ///< particles of the patch, ascending; none that never moves
  std::vector<double> weight;                        ///< of each in the place of the patch, sum 1
  Eigen::Vector3d target = Eigen::Vector3d::Zero();  ///< where the spring ends, world [m]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< hand on tissue in the last step, world [N]

  bool holds() const { return !node.empty(); }
};

}  // namespace vibe
