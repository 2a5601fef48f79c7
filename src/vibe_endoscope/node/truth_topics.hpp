#pragma once
#include <ros/node_handle.h>
#include <sensor_msgs/Image.h>
#include <std_msgs/Header.h>

#include <optional>
#include <string>

#include "truth/truth_camera.hpp"

namespace vibe::endoscope {

/// The truth of one lens as topics: depth, normals, labels, optical flow, pose. Only what has subscribers is computed.
class TruthTopics {
 public:
  /// @param prefix   of the topics, "endoscope/" or "endoscope/left/"
  /// @param changed  called when subscribers come or go
  TruthTopics(ros::NodeHandle& node, const std::string& prefix, const ros::SubscriberStatusCallback& changed);

  bool isWatched() const;
  /// Whether rays have to be cast.
  bool needsRays() const;

  /// @param header  of the images
  /// @param frame   of the scene, in which the pose is given
  /// @param scene   committed, unless needsRays() is false
  void publish(const TruthCamera& camera, const TruthScene& scene, const Eigen::Isometry3d& pose,
               const std_msgs::Header& header, const std::string& frame);
  /// There is no flow from the last image to the next one.
  void forget() { before_.reset(); }

 private:
  /// The last image, from which the flow to the next one starts.
  struct Before {
    TruthView view;
    std_msgs::Header header;
  };
  bool wantsFlow() const { return flow_.getNumSubscribers() > 0 || flow_visible_.getNumSubscribers() > 0; }
  void publishPose(const Eigen::Isometry3d& pose, const std_msgs::Header& header, const std::string& frame);
  void publishFlow(const TruthCamera& camera, const TruthScene& scene, const Eigen::Isometry3d& pose);

  ros::Publisher depth_, normals_, labels_, flow_, flow_visible_, pose_;
  std::optional<Before> before_;
};

}  // namespace vibe::endoscope
