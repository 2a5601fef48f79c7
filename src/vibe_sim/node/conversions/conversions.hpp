#pragma once
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <ros/time.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <string>

// Messages <-> library, without any ROS graph: what all of this room use. Functions of the room that read a message
// throw vibe::Error with one sentence if the message cannot be used.

namespace vibe::sim {

constexpr const char* kWorldFrame = "world";
constexpr const char* kTissueFrame = "stomach";
constexpr const char* kScopeBaseFrame = "scope_base";
constexpr const char* kScopeTipFrame = "scope_tip";

/// Whether a value has its number in a message.
template <typename Enum>
constexpr bool same(Enum ours, std::uint8_t wire) {
  return static_cast<std::uint8_t>(ours) == wire;
}

/// @param Message  geometry_msgs::Point or Vector3
template <typename Message>
Eigen::Vector3d toVector(const Message& message) {
  return {message.x, message.y, message.z};
}

/// The other way round.
template <typename Message>
Message toMessage(const Eigen::Vector3d& v) {
  Message message;
  message.x = v.x();
  message.y = v.y();
  message.z = v.z();
  return message;
}

/// Messages cannot carry times before 0; such a stamp becomes 0.
ros::Time toRosTime(std::int64_t nanoseconds);
std::int64_t fromRosTime(const ros::Time& time);

/// An empty message with a header.
template <typename Message>
Message stamped(std::int64_t stamp, const std::string& frame = "") {
  Message message;
  message.header.stamp = toRosTime(stamp);
  message.header.frame_id = frame;
  return message;
}

geometry_msgs::Quaternion toQuaternion(const Eigen::Quaterniond& q);
geometry_msgs::PoseStamped makePose(const Eigen::Isometry3d& pose, const std::string& frame, std::int64_t stamp);
geometry_msgs::TransformStamped makeTransform(const Eigen::Isometry3d& pose, const std::string& parent,
                                              const std::string& child, std::int64_t stamp);

/// What a message says, in quotation marks for a sentence: one line of printable ASCII, and no more than fits there.
std::string quoted(const std::string& text);

}  // namespace vibe::sim
