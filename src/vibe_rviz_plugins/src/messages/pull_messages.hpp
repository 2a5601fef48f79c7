#pragma once
#include <vibe_msgs/TissuePullState.h>

#include <Eigen/Core>
#include <string>

namespace vibe {

/// The simulator's hand after a step.
struct PullState {
  int particle = -1;                                 ///< -1: it has let go
  Eigen::Vector3d place = Eigen::Vector3d::Zero();   ///< of the held patch [m]
  Eigen::Vector3d target = Eigen::Vector3d::Zero();  ///< after the simulator's limits [m]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< hand on tissue [N]
};

/// Checks and takes over a message. An empty answer: it is right and the result is filled; else what is wrong.
std::string readPullState(const vibe_msgs::TissuePullState& message, PullState& state);

}  // namespace vibe
