#include "conversions/conversions.hpp"

#include <algorithm>

namespace vibe::sim {
ros::Time toRosTime(std::int64_t nanoseconds) {
  ros::Time time;
  time.fromNSec(static_cast<std::uint64_t>(std::max<std::int64_t>(nanoseconds, 0)));
  return time;
}

std::int64_t fromRosTime(const ros::Time& time) {
  return static_cast<std::int64_t>(time.toNSec());
}

geometry_msgs::Quaternion toQuaternion(const Eigen::Quaterniond& q) {
  geometry_msgs::Quaternion message;
  message.x = q.x();
  message.y = q.y();
  message.z = q.z();
  message.w = q.w();
  return message;
}

geometry_msgs::PoseStamped makePose(const Eigen::Isometry3d& pose, const std::string& frame, std::int64_t stamp) {
  auto message = stamped<geometry_msgs::PoseStamped>(stamp, frame);
  message.pose.position = toMessage<geometry_msgs::Point>(pose.translation());
  message.pose.orientation = toQuaternion(Eigen::Quaterniond(pose.linear()));
  return message;
}

geometry_msgs::TransformStamped makeTransform(const Eigen::Isometry3d& pose, const std::string& parent,
                                              const std::string& child, std::int64_t stamp) {
  auto message = stamped<geometry_msgs::TransformStamped>(stamp, parent);
  message.child_frame_id = child;
  message.transform.translation = toMessage<geometry_msgs::Vector3>(pose.translation());
  message.transform.rotation = toQuaternion(Eigen::Quaterniond(pose.linear()));
  return message;
}

std::string quoted(const std::string& text) {
  constexpr std::size_t kMost = 60;
  std::string result = text.size() > kMost ? text.substr(0, kMost) + "..." : text;
  std::replace_if(
      result.begin(), result.end(), [](char c) { return c < ' ' || c > '~' || c == '\''; }, '?');
  return "'" + result + "'";
}

}  // namespace vibe::sim
