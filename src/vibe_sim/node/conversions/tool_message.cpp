#include "conversions/tool_message.hpp"

#include <Eigen/Geometry>

#include "conversions/conversions.hpp"
#include "vibe_core/common/rotation.hpp"

namespace vibe::sim {

namespace {

sensor_msgs::JointState makeMeasured(const State& state, const JointArray& velocity, int first, int count,
                                     std::int64_t stamp) {
  const JointArray position = toolJoints(state);
  sensor_msgs::JointState message;
  message.header.stamp = toRosTime(stamp);
  message.header.frame_id = kScopeBaseFrame;
  message.name.assign(kJointNames.begin() + first, kJointNames.begin() + first + count);
  message.position.assign(position.begin() + first, position.begin() + first + count);
  message.velocity.assign(velocity.begin() + first, velocity.begin() + first + count);
  return message;
}

std_msgs::MultiArrayDimension makeDimension(const char* label, std::uint32_t size, std::uint32_t stride) {
  std_msgs::MultiArrayDimension dimension;
  dimension.label = label;
  dimension.size = size;
  dimension.stride = stride;
  return dimension;
}

}  // namespace

JointArray toolJoints(const State& state) {
  JointArray joints = state.joints;
  for (int j = 0; j < kScopeJointCount; ++j) joints[j] += state.tool_displacement[j];
  return joints;
}

sensor_msgs::JointState makeMeasuredScope(const State& state, const JointArray& velocity, std::int64_t stamp) {
  sensor_msgs::JointState message = makeMeasured(state, velocity, 0, kScopeJointCount, stamp);
  message.effort.assign(state.hand_effort.begin(), state.hand_effort.end());
  return message;
}

sensor_msgs::JointState makeMeasuredOverstitch(const State& state, const JointArray& velocity, std::int64_t stamp) {
  return makeMeasured(state, velocity, kScopeJointCount, kJointCount - kScopeJointCount, stamp);
}

vibe_msgs::OperatingState makeOperatingState(bool present, bool paused, bool busy, std::int64_t stamp) {
  vibe_msgs::OperatingState message;
  message.header.stamp = toRosTime(stamp);
  message.state = !present ? "DISABLED" : paused ? "PAUSED" : "ENABLED";
  message.is_homed = present;
  message.is_busy = present && busy;
  return message;
}

std_msgs::Float64MultiArray makeJacobian(const TipJacobian& jacobian) {
  std_msgs::Float64MultiArray message;
  message.layout.dim = {makeDimension("twist", 6, 6 * kScopeJointCount),
                        makeDimension("joint", kScopeJointCount, kScopeJointCount)};
  for (int row = 0; row < jacobian.rows(); ++row)
    for (int column = 0; column < jacobian.cols(); ++column) message.data.push_back(jacobian(row, column));
  return message;
}

geometry_msgs::PoseStamped makeWallPose(const WallSight& sight, std::int64_t stamp) {
  const Eigen::Quaterniond turn = rotationBetween(Eigen::Vector3d::UnitX(), sight.normal);
  return makePose(Eigen::Translation3d(sight.point) * turn, kWorldFrame, stamp);
}

}  // namespace vibe::sim
