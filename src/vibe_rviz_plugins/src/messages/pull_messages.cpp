#include "messages/pull_messages.hpp"

#include "messages/max_coordinate.hpp"

namespace vibe::rviz_plugins {

namespace {

constexpr double kMaxForce = 1e6;  // [N]

template <class Message>
bool read(const Message& message, double max, Eigen::Vector3d& result) {
  result = {message.x, message.y, message.z};
  return result.cwiseAbs().maxCoeff() < max && result.allFinite();
}

}  // namespace

std::string readPullState(const vibe_msgs::TissuePullState& message, PullState& state) {
  PullState read_state;
  read_state.particle = message.particle;
  if (message.particle < -1)
    return "The pull spring refers to particle " + std::to_string(message.particle) + ", which does not exist.";
  if (!read(message.position, kMaxCoordinate, read_state.position) ||
      !read(message.target, kMaxCoordinate, read_state.target))
    return "The position or the target of the pull spring is invalid (not finite, or beyond 1000 km).";
  if (!read(message.force, kMaxForce, read_state.force))
    return "The force of the pull spring is invalid (not finite, or beyond 1e6 N).";
  state = read_state;
  return "";
}

}  // namespace vibe::rviz_plugins
