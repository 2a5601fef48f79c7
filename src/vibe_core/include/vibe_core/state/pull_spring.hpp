#pragma once
#include <Eigen/Core>
#include <vector>

namespace vibe {

constexpr double kPullStiffness = 300;  ///< between patch and target; design choice [N/m]
constexpr double kPullForce = 5;        ///< maximum; the target is kept near enough for it. Design choice [N]
constexpr double kPullSpeed = 0.25;     ///< maximum, of the target, so that a jump of the mouse tears nothing [m/s]
constexpr double kPullRadius = 6e-3;    ///< of the patch around the particle, in the rest shape [m]

/// Pulls the tissue at one place: a spring from the weighted mean position of a patch of the wall to a target that
/// follows StepInput::pull_target.
struct PullSpring {
  int particle = -1;                                 ///< at the centre of the patch; -1: nothing is held
  std::vector<int> node;                             ///< particles of the patch, ascending, without fixed ones
  std::vector<double> weight;                        ///< of each in the mean position, sum 1
  Eigen::Vector3d target = Eigen::Vector3d::Zero();  ///< end of the spring, world [m]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< spring on tissue in the last step, world [N]

  bool holds() const { return !node.empty(); }
};

}  // namespace vibe
