#include "vibe_operator/messages/command_messages.hpp"

#include <algorithm>
#include <cmath>

#include <urdf/model.h>

namespace vibe::operating {

namespace {

constexpr std::size_t kScopeJoints = 4;
constexpr double kStateSlack = 0.5;  // between the time of a state and its stamp [s]

std::string readLimit(const urdf::Model& model, const std::string& name, JointLimit& limit) {
  const urdf::JointConstSharedPtr joint = model.getJoint(name);
  if (!joint || !joint->limits)
    return "The robot_description has no joint '" + name + "' with limits; set the URDF of vibe_description.";
  limit = {joint->limits->lower, joint->limits->upper, joint->limits->velocity};
  if (std::isfinite(limit.lower) && limit.lower < limit.upper && std::isfinite(limit.upper) && limit.velocity > 0 &&
      std::isfinite(limit.velocity))
    return {};
  return "The limits of joint '" + name + "' in the robot_description leave it no way to move; correct the URDF.";
}

sensor_msgs::JointState messageOf(const Joints& joints, std::size_t begin, std::size_t end, const ros::Time& stamp) {
  sensor_msgs::JointState message;
  message.header.stamp = stamp;
  for (std::size_t i = begin; i < end; ++i) {
    message.name.push_back(driveJointNames()[i]);
    message.position.push_back(joints[i]);
  }
  return message;
}

}  // namespace

std::string readJointLimits(const std::string& urdf, JointLimits& limits) {
  urdf::Model model;
  if (urdf.empty() || !model.initString(urdf)) return "The parameter robot_description holds no URDF that can be read.";
  for (std::size_t i = 0; i < limits.size(); ++i) {
    const std::string wrong = readLimit(model, driveJointNames()[i], limits[i]);
    if (!wrong.empty()) return wrong;
  }
  return {};
}

bool readJoints(const sensor_msgs::JointState& message, Joints& joints) {
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const auto found = std::find(message.name.begin(), message.name.end(), driveJointNames()[i]);
    const auto place = static_cast<std::size_t>(found - message.name.begin());
    if (found == message.name.end() || place >= message.position.size() || !std::isfinite(message.position[place]))
      return false;
    joints[i] = message.position[place];
  }
  return true;
}

sensor_msgs::JointState scopeMessage(const Joints& joints, const ros::Time& stamp) {
  return messageOf(joints, 0, kScopeJoints, stamp);
}

sensor_msgs::JointState suturingDeviceMessage(const Joints& joints, const ros::Time& stamp) {
  return messageOf(joints, kScopeJoints, joints.size(), stamp);
}

bool isOtherSession(const vibe_msgs::ProcedureState& before, const vibe_msgs::ProcedureState& now) {
  if (now.step < before.step || now.scene != before.scene) return true;
  const double by_stamp = (now.header.stamp - before.header.stamp).toSec();
  return now.time - before.time > by_stamp + kStateSlack;  // less is possible: a slow simulator drops wall time
}

DriveSituation situationOf(const vibe_msgs::ProcedureState& state) {
  DriveSituation now;
  now.pressure = state.pressure;
  now.touches = state.tool_state == "contact" || state.tool_state == "grip";
  now.holds = state.held_particles > 0;
  now.needle_loaded = state.needle_loaded;
  now.needle_on_arm = state.needle_on_arm;
  now.marks = state.marks;
  now.sets_done = state.sutures_cinched + state.sutures_loose + state.sutures_broken;
  now.set_bites = state.bites;  // the steps are those of the first set
  now.sets_tagged = !state.needle_loaded && state.sutures_open > 0 ? 1 : 0;
  return now;
}

namespace {

constexpr double kMaxCoordinate = 1e6;  // [m]
constexpr double kMaxForce = 1e6;       // [N]

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

}  // namespace vibe::operating
