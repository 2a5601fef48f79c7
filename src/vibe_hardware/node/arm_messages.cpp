#include "arm_messages.hpp"

#include <algorithm>
#include <boost/algorithm/string/join.hpp>
#include <cmath>

namespace vibe::hardware {
namespace {

constexpr double kReach = 10;  // no arm is larger [m]

std::string faultOf(const geometry_msgs::Pose& pose) {
  const Eigen::Vector3d p(pose.position.x, pose.position.y, pose.position.z);
  const auto& q = pose.orientation;
  const double norm = Eigen::Vector4d(q.x, q.y, q.z, q.w).norm();
  if (!p.allFinite() || !std::isfinite(norm)) return "a number is not finite";
  if (std::abs(norm - 1) > 1e-2) return "its quaternion has another length than 1";
  if (p.norm() > kReach) return "it is more than 10 m away from the base; the driver may publish millimetres";
  return "";
}

}  // namespace

MessageFault readPose(const geometry_msgs::PoseStamped& message, ArmSample& sample) {
  if (message.header.stamp.isZero()) return {"its stamp is 0"};  // CRTK: invalid
  const auto& p = message.pose.position;
  const auto& q = message.pose.orientation;
  sample.position = {p.x, p.y, p.z};
  sample.orientation = Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized();
  return {faultOf(message.pose)};
}

MessageFault readArmJoints(const sensor_msgs::JointState& message, const std::vector<std::string>& names,
                           ArmSample& sample) {
  for (std::size_t j = 0; j < names.size(); ++j) {
    const auto found = std::find(message.name.begin(), message.name.end(), names[j]);
    const auto index = static_cast<std::size_t>(found - message.name.begin());
    if (found == message.name.end())
      return {"has no joint '" + names[j] + "' but " + boost::algorithm::join(message.name, ", "), true};
    if (message.header.stamp.isZero() || index >= message.position.size() || !std::isfinite(message.position[index]))
      return {"its stamp is 0, or the position of '" + names[j] + "' is missing or not finite"};
    sample.joints[j] = message.position[index];
  }
  return {};
}

geometry_msgs::WrenchStamped makeArmForce(const TeleopOutput& output, const std::string& frame,
                                          const ros::Time& stamp) {
  geometry_msgs::WrenchStamped message;
  message.header.stamp = stamp;
  message.header.frame_id = frame;
  message.wrench.force.x = output.force.x();
  message.wrench.force.y = output.force.y();
  message.wrench.force.z = output.force.z();
  message.wrench.torque.x = output.torque.x();
  message.wrench.torque.y = output.torque.y();
  message.wrench.torque.z = output.torque.z();
  return message;
}

sensor_msgs::JointState makeArmEfforts(const TeleopOutput& output, const std::vector<std::string>& names,
                                       const ros::Time& stamp) {
  sensor_msgs::JointState message;
  message.header.stamp = stamp;
  message.name = names;
  message.effort.assign(output.efforts.begin(), output.efforts.begin() + static_cast<std::ptrdiff_t>(names.size()));
  return message;
}

}  // namespace vibe::hardware
