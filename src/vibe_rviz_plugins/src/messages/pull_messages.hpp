#pragma once
#include <vibe_msgs/TissuePullState.h>

#include <Eigen/Core>
#include <string>

namespace vibe::rviz_plugins {

/// The pull spring after a step.
struct PullState {
  int particle = -1;                                   ///< -1: it is released
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< of the held patch [m]
  Eigen::Vector3d target = Eigen::Vector3d::Zero();    ///< after the simulator's limits [m]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();     ///< of the spring on the tissue [N]
};

/// Checks and reads a message.
/// @return empty, and the state is set; otherwise one sentence that says what is wrong
std::string readPullState(const vibe_msgs::TissuePullState& message, PullState& state);

}  // namespace vibe::rviz_plugins
