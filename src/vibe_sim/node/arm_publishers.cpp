#include "arm_publishers.hpp"

#include <algorithm>

#include "arm_message.hpp"

namespace vibe::sim {

ArmPublishers::ArmPublishers(OutletSource& outlets)
    : scope_(outlets.advertise<sensor_msgs::JointState>("scope/simulated/measured_js", kSmallQueue)),
      overstitch_(outlets.advertise<sensor_msgs::JointState>("overstitch/simulated/measured_js", kSmallQueue)),
      jacobian_(outlets.advertise<std_msgs::Float64MultiArray>("scope/jacobian", kSmallQueue)),
      wall_(outlets.advertise<geometry_msgs::PoseStamped>("wall/measured_cp", kSmallQueue)),
      scope_state_(outlets.advertise<vibe_msgs::OperatingState>("scope/operating_state", kSmallQueue, true)),
      overstitch_state_(outlets.advertise<vibe_msgs::OperatingState>("overstitch/operating_state", kSmallQueue, true)) {
}

void ArmPublishers::place(const Session& session, bool continues, std::int64_t stamp) {
  const JointArray joints = toolJoints(session.state);
  JointArray velocity{};
  for (int j = 0; continues && j < kJointCount; ++j)
    velocity[j] = (joints[j] - last_joints_[j]) / session.time.period();
  last_joints_ = joints;
  scope_.publish(makeMeasuredScope(session.state, velocity, stamp));
  overstitch_.publish(makeMeasuredOverstitch(session.state, velocity, stamp));
  if (jacobian_.getNumSubscribers() > 0) jacobian_.publish(makeJacobian(tipJacobian(*session.model, session.state)));
  if (wall_.getNumSubscribers() == 0) return;
  if (const auto sight = lookAhead(*session.model, session.state)) wall_.publish(makeWallPose(*sight, stamp));
}

void ArmPublishers::operatingState(const Session& session, const RunStatus& status) {
  const bool present = session.model->tool != nullptr;
  const auto scope = makeOperatingState(present, status.paused, status.scope_moves, session.now());
  const auto overstitch = makeOperatingState(present, status.paused, status.overstitch_moves, session.now());
  const std::string state = scope.state + (scope.is_busy ? " scope" : "") + (overstitch.is_busy ? " overstitch" : "");
  if (state == last_state_) return;
  last_state_ = state;
  scope_state_.publish(scope);
  overstitch_state_.publish(overstitch);
}

bool ArmPublishers::hasListener() const {
  const auto all = {&scope_, &overstitch_, &jacobian_, &wall_, &scope_state_, &overstitch_state_};
  return std::any_of(all.begin(), all.end(), [](const Outlet* outlet) { return outlet->getNumSubscribers() > 0; });
}

}  // namespace vibe::sim
