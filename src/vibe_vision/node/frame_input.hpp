#pragma once

#include <mutex>
#include <string>

#include <ros/node_handle.h>

#include "vibe_vision/camera/capture.hpp"
#include "vision_messages.hpp"
#include "vision_parameters.hpp"

namespace vibe::vision {

/// Images of another node, from the topic `image`, raw or compressed, with the camera_info beside it if there is one.
/// In a nodelet raw images are shared, not copied.
class TopicInput : public FrameInput {
 public:
  TopicInput(ros::NodeHandle handle, const VisionParameters& parameters);
  ReadResult take(Frame& frame, double timeout) override { return latest_.take(frame, timeout); }
  std::uint64_t dropped() const override { return latest_.dropped(); }
  SourceStatistics statistics() const override;
  std::string status() const override;

 private:
  double exposure_;
  bool start_stamped_;
  LatestFrame latest_;
  mutable std::mutex mutex_;  // of what follows, up to the topic
  SourceStatistics statistics_;
  std::uint64_t last_sequence_ = 0;
  std::string complaint_;
  sensor_msgs::ImageConstPtr image_;  ///< without its camera_info so far
  sensor_msgs::CameraInfoConstPtr info_;
  SampleDepth depth_;
  std::string topic_;
  ros::Subscriber image_subscriber_, info_subscriber_;

  void onCompressed(const sensor_msgs::CompressedImageConstPtr& message);
  void onImage(const sensor_msgs::ImageConstPtr& image);
  void onInfo(const sensor_msgs::CameraInfoConstPtr& info);
  void pair();
  void use(const sensor_msgs::CameraInfo& info);
  void refuse(const std::string& complaint);
  void count(std::uint64_t sequence);
};

}  // namespace vibe::vision
