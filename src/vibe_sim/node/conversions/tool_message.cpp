#include "conversions/tool_message.hpp"

#include <Eigen/Geometry>

#include "conversions/conversions.hpp"
#include "conversions/input_message.hpp"
#include "vibe_core/arithmetic/rotation.hpp"
#include "vibe_core/simulation/tool_queries.hpp"

namespace vibe::sim {

namespace {

sensor_msgs::JointState makeMeasured(const State& state, const JointArray& velocity, JointRange range,
                                     std::int64_t stamp) {
  sensor_msgs::JointState message = makeJoints(toolJoints(state), range, stamp);
  message.velocity.assign(velocity.begin() + range.first, velocity.begin() + range.first + range.count);
  return message;
}

// The numbers on the wire are those of the library.
static_assert(same(ToolContact::Kind::Contact, vibe_msgs::ToolContact::CONTACT) &&
              same(ToolContact::Kind::Grip, vibe_msgs::ToolContact::GRIP));

vibe_msgs::ToolContact makeToolContact(const ToolModel& tool, const ToolContact& contact) {
  vibe_msgs::ToolContact message;
  message.kind = static_cast<std::uint8_t>(contact.kind);
  message.position = toMessage<geometry_msgs::Point>(contact.point);
  message.normal = toMessage<geometry_msgs::Vector3>(contact.normal);
  message.gap = contact.gap;
  message.force = toMessage<geometry_msgs::Vector3>(contact.force);
  message.normal_force = contact.normalForce();
  message.tangential_force = toMessage<geometry_msgs::Vector3>(contact.tangentialForce());
  message.link = tool.linkName(contact.link);
  message.shape = contact.shape;
  message.triangle = contact.triangle;
  const SurfacePoint& point = contact.surface;
  message.nodes.assign(point.node.begin(), point.node.begin() + point.count);
  message.weights.assign(point.weight.begin(), point.weight.begin() + point.count);
  message.region = static_cast<std::uint8_t>(contact.region);
  message.wall = static_cast<std::uint8_t>(contact.wall);
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
  sensor_msgs::JointState message = makeMeasured(state, velocity, jointsOf(InputChannel::Scope), stamp);
  message.effort.assign(state.hand_effort.begin(), state.hand_effort.end());
  return message;
}

sensor_msgs::JointState makeMeasuredSuturingDevice(const State& state, const JointArray& velocity, std::int64_t stamp) {
  return makeMeasured(state, velocity, jointsOf(InputChannel::SuturingDevice), stamp);
}

geometry_msgs::TwistStamped makeTipTwist(const Eigen::Isometry3d& before, const Eigen::Isometry3d& now, double seconds,
                                         std::int64_t stamp) {
  const Eigen::AngleAxisd turn(Eigen::Quaterniond(now.linear() * before.linear().transpose()).normalized());
  auto message = stamped<geometry_msgs::TwistStamped>(stamp, kWorldFrame);
  message.twist.linear =
      toMessage<geometry_msgs::Vector3>(Eigen::Vector3d((now.translation() - before.translation()) / seconds));
  message.twist.angular = toMessage<geometry_msgs::Vector3>(Eigen::Vector3d(turn.axis() * (turn.angle() / seconds)));
  return message;
}

vibe_msgs::OperatingState makeOperatingState(bool present, bool paused, bool busy, std::int64_t stamp) {
  auto message = stamped<vibe_msgs::OperatingState>(stamp);
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

sensor_msgs::JointState makeJointState(const Model& model, const State& state, std::int64_t stamp) {
  const ToolModel& tool = *model.tool;
  sensor_msgs::JointState message = makeJoints(toolJoints(state), {0, kJointCount}, stamp);
  const ShaftBend bend = tool.shaftBend(state.joints, state.tool_displacement);
  for (const ToolJoint& joint : tool.joints()) {
    if (joint.station < 0) continue;
    message.name.push_back(joint.name);
    message.position.push_back(bend.angle(joint.station, joint.direction));
  }
  for (const DrawnJoint& joint : drawnJoints(model, state)) {
    message.name.push_back(joint.name);
    message.position.push_back(joint.position);
  }
  return message;
}

sensor_msgs::JointState makeHandJoints(const State& state, std::int64_t stamp) {
  sensor_msgs::JointState message = makeJoints(state.joints, jointsOf(InputChannel::Scope), stamp);
  message.effort.assign(state.hand_effort.begin(), state.hand_effort.end());
  return message;
}

geometry_msgs::WrenchStamped makeWrench(const State& state, std::int64_t stamp) {
  auto message = stamped<geometry_msgs::WrenchStamped>(stamp, kScopeTipFrame);
  message.wrench.force = toMessage<geometry_msgs::Vector3>(state.tool_force);
  message.wrench.torque = toMessage<geometry_msgs::Vector3>(state.tool_torque);
  return message;
}

vibe_msgs::HapticParameters makeHapticRelease(std::int64_t stamp) {
  auto message = stamped<vibe_msgs::HapticParameters>(stamp, kWorldFrame);
  message.joint_name.assign(kJointNames.begin(), kJointNames.begin() + kScopeJointCount);
  return message;
}

vibe_msgs::HapticParameters makeHapticParameters(const ToolImpedance& response, double force_limit,
                                                 std::int64_t stamp) {
  vibe_msgs::HapticParameters message = makeHapticRelease(stamp);
  message.touching = 1;
  message.position = toMessage<geometry_msgs::Point>(response.position);
  message.velocity = toMessage<geometry_msgs::Vector3>(response.velocity);
  message.force = toMessage<geometry_msgs::Vector3>(response.force);
  message.equilibrium = toMessage<geometry_msgs::Point>(response.equilibrium);
  message.force_limit = force_limit;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) {
      message.stiffness[3 * row + column] = response.stiffness(row, column);
      message.damping[3 * row + column] = response.damping(row, column);
    }
  for (int j = 0; j < kScopeJointCount; ++j) {
    const JointResponse& joint = response.joints[j];
    message.joint_position[j] = joint.position;
    message.joint_velocity[j] = joint.velocity;
    message.joint_effort[j] = joint.effort;
    message.joint_stiffness[j] = joint.stiffness;
    message.joint_damping[j] = joint.damping;
    message.joint_equilibrium[j] = joint.equilibrium;
  }
  return message;
}

vibe_msgs::ToolContacts makeToolContacts(const TimedSimulation& simulation) {
  auto message = stamped<vibe_msgs::ToolContacts>(simulation.now(), kWorldFrame);
  for (const ToolContact& contact : simulation.simulation().contacts())
    message.contacts.push_back(makeToolContact(*simulation.model().tool, contact));
  return message;
}

}  // namespace vibe::sim
