#include "messages/pull_messages.hpp"

namespace vibe {

namespace {

constexpr double kFarthest = 1e6;   // a place farther away is a mistake [m]
constexpr double kStrongest = 1e6;  // [N]

template <class Message>
bool read(const Message& message, double max, Eigen::Vector3d& result) {
  result = {message.x, message.y, message.z};
  return result.cwiseAbs().maxCoeff() < max && result.allFinite();
}

}  // namespace

std::string readPullState(const vibe_msgs::TissuePullState& message, PullState& state) {
  PullState read_state;
  read_state.particle = message.particle;
  if (message.particle < -1) return "The hand's particle is " + std::to_string(message.particle) + ".";
  if (!read(message.position, kFarthest, read_state.place) || !read(message.target, kFarthest, read_state.target))
    return "The hand's place or target is no place in metres.";
  if (!read(message.force, kStrongest, read_state.force)) return "The hand's force is no force in newtons.";
  state = read_state;
  return "";
}

}  // namespace vibe
