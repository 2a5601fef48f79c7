#include "viewer_topics.hpp"

#include <geometry_msgs/PoseStamped.h>
#include <sensor_msgs/Joy.h>

#include "protocol/viewer_message.hpp"

namespace vibe::web {

namespace {

constexpr double kPosePeriod = 1.0 / 60;  // [s]
constexpr double kPoseSilence = 1;        // [s]
constexpr std::uint32_t kPoseQueue = 10;

geometry_msgs::PoseStamped poseMessage(const ViewerState::Pose& pose, const ros::Time& stamp) {
  geometry_msgs::PoseStamped message;
  message.header.stamp = stamp;
  message.header.frame_id = "world";
  auto& p = message.pose.position;
  auto& q = message.pose.orientation;
  p.x = pose[0], p.y = pose[1], p.z = pose[2];
  q.x = pose[3], q.y = pose[4], q.z = pose[5], q.w = pose[6];
  return message;
}

}  // namespace

ViewerTopics::ViewerTopics(ros::NodeHandle& handle)
    : poses_{handle.advertise<geometry_msgs::PoseStamped>("viewer/head", kPoseQueue),
             handle.advertise<geometry_msgs::PoseStamped>("viewer/left_hand", kPoseQueue),
             handle.advertise<geometry_msgs::PoseStamped>("viewer/right_hand", kPoseQueue)},
      buttons_(handle.advertise<sensor_msgs::Joy>("viewer/buttons", kPoseQueue)) {}

void ViewerTopics::tick(double now, WebServer& server) {
  if (received_ && now - last_ >= kPosePeriod) {
    publish(*received_);
    server.publish(Kind::Viewer, encodeViewer(*received_));
    received_.reset();
    last_ = now;
    shown_ = true;
  }
  if (!shown_ || now - last_ < kPoseSilence) return;
  server.publish(Kind::Viewer, encodeViewer({}));
  shown_ = false;
}

void ViewerTopics::publish(const ViewerState& viewer) {
  const ros::Time stamp = ros::Time::now();
  for (std::size_t k = 0; k < kViewerBodies; ++k)
    if (viewer.poses[k]) poses_[k].publish(poseMessage(*viewer.poses[k], stamp));
  sensor_msgs::Joy buttons;
  buttons.header.stamp = stamp;
  buttons.axes.assign(viewer.sticks.begin(), viewer.sticks.end());
  buttons.buttons.assign(viewer.buttons.begin(), viewer.buttons.end());
  buttons_.publish(buttons);
}

}  // namespace vibe::web
