#pragma once
#include <geometry_msgs/PoseStamped.h>
#include <ros/node_handle.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/image_encodings.h>
#include <std_msgs/Header.h>
#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <string>

#include "truth/truth_camera.hpp"

namespace vibe::endoscope {

/// The truth of one lens as topics: depth, normals, labels, optical flow, pose. Only what has subscribers is computed.
class TruthTopics {
 public:
  /// @param prefix   of the topics, "endoscope/" or "endoscope/left/"
  /// @param changed  called when subscribers come or go
  TruthTopics(ros::NodeHandle& node, const std::string& prefix, const ros::SubscriberStatusCallback& changed) {
    const auto image = [&](const char* name) {
      return node.advertise<sensor_msgs::Image>(prefix + name, 2, changed, changed);
    };
    depth_ = image("depth/image_raw");
    normals_ = image("normals");
    labels_ = image("labels");
    flow_ = image("flow");
    flow_visible_ = image("flow_visible");
    pose_ = node.advertise<geometry_msgs::PoseStamped>(prefix + "pose", 2, changed, changed);
  }

  bool isWatched() const { return needsRays() || pose_.getNumSubscribers() > 0; }

  /// Whether rays have to be cast.
  bool needsRays() const {
    const std::array<const ros::Publisher*, 5> all{&depth_, &normals_, &labels_, &flow_, &flow_visible_};
    return std::any_of(all.begin(), all.end(),
                       [](const auto* publisher) { return publisher->getNumSubscribers() > 0; });
  }

  /// @param header  of the images
  /// @param frame   of the scene, in which the pose is given
  /// @param scene   committed, unless needsRays() is false
  void publish(const TruthCamera& camera, const TruthScene& scene, const Eigen::Isometry3d& pose,
               const std_msgs::Header& header, const std::string& frame) {
    if (pose_.getNumSubscribers() > 0) publishPose(pose, header, frame);
    if (!wantsFlow()) forget();
    if (!needsRays()) return;
    if (before_ && before_->header.stamp < header.stamp) publishFlow(camera, scene, pose);  // else time was set back
    Before now;
    now.header = header;
    camera.look(scene, pose, now.view);
    if (depth_.getNumSubscribers() > 0)
      depth_.publish(
          imageOf(header, camera.round(), sensor_msgs::image_encodings::TYPE_32FC1, camera.depth(scene, now.view)));
    if (normals_.getNumSubscribers() > 0)
      normals_.publish(
          imageOf(header, camera.round(), sensor_msgs::image_encodings::TYPE_32FC3, camera.normals(scene, now.view)));
    if (labels_.getNumSubscribers() > 0)
      labels_.publish(
          imageOf(header, camera.round(), sensor_msgs::image_encodings::TYPE_8UC1, camera.labels(scene, now.view)));
    if (wantsFlow()) before_ = std::move(now);
  }

  /// There is no flow from the last image to the next one.
  void forget() { before_.reset(); }

 private:
  /// The last image, from which the flow to the next one starts.
  struct Before {
    TruthView view;
    std_msgs::Header header;
  };
  template <class T>
  static sensor_msgs::ImagePtr imageOf(const std_msgs::Header& header, const graphics::RoundCamera& round,
                                       const std::string& encoding, const std::vector<T>& values) {
    sensor_msgs::ImagePtr image = boost::make_shared<sensor_msgs::Image>();
    image->header = header;
    image->width = static_cast<std::uint32_t>(round.width), image->height = static_cast<std::uint32_t>(round.height);
    image->encoding = encoding;
    image->data.resize(values.size() * sizeof(T));
    image->step = static_cast<std::uint32_t>(image->data.size() / image->height);
    std::memcpy(image->data.data(), values.data(), image->data.size());
    return image;
  }

  bool wantsFlow() const { return flow_.getNumSubscribers() > 0 || flow_visible_.getNumSubscribers() > 0; }

  void publishPose(const Eigen::Isometry3d& pose, const std_msgs::Header& header, const std::string& frame) {
    geometry_msgs::PoseStamped message;
    message.header = header;
    message.header.frame_id = frame;
    const Eigen::Vector3d& place = pose.translation();
    const Eigen::Quaterniond turn(pose.linear());
    message.pose.position.x = place.x(), message.pose.position.y = place.y(), message.pose.position.z = place.z();
    message.pose.orientation.x = turn.x(), message.pose.orientation.y = turn.y();
    message.pose.orientation.z = turn.z(), message.pose.orientation.w = turn.w();
    pose_.publish(message);
  }

  void publishFlow(const TruthCamera& camera, const TruthScene& scene, const Eigen::Isometry3d& pose) {
    const TruthFlow flow = camera.flow(before_->view, scene, pose);
    flow_.publish(imageOf(before_->header, camera.round(), sensor_msgs::image_encodings::TYPE_32FC2, flow.motion));
    flow_visible_.publish(
        imageOf(before_->header, camera.round(), sensor_msgs::image_encodings::TYPE_8UC1, flow.visible));
  }

  ros::Publisher depth_, normals_, labels_, flow_, flow_visible_, pose_;
  std::optional<Before> before_;
};

}  // namespace vibe::endoscope
