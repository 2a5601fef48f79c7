#pragma once

#include <memory>
#include <mutex>
#include <string>

#include <ros/node_handle.h>

#include "vibe_vision/camera/capture.hpp"
#include "vision_messages.hpp"
#include "vision_parameters.hpp"

namespace vibe::vision {

/// What the node gets frames from: a camera of its own or a topic. The newest frame wins.
class FrameInput {
 public:
  virtual ~FrameInput() = default;
  /// @param timeout  [s]
  virtual ReadResult take(Frame& frame, double timeout) = 0;
  virtual SourceStatistics statistics() const = 0;
  virtual std::uint64_t dropped() const = 0;  ///< frames that a newer one has replaced
  virtual std::string status() const = 0;     ///< one line for people
};

/// A camera or a recording that belongs to the node.
class CameraInput : public FrameInput {
 public:
  CameraInput(const std::string& address, const SourceOptions& options) : capture_(openSource(address, options)) {}
  ReadResult take(Frame& frame, double timeout) override { return capture_.take(frame, timeout); }
  SourceStatistics statistics() const override { return capture_.statistics(); }
  std::uint64_t dropped() const override { return capture_.dropped(); }
  std::string status() const override { return capture_.status(); }

 private:
  Capture capture_;
};

/// Images of another node, from the topic `image`, raw or compressed, with the camera_info beside it if there is one.
/// In a nodelet raw images are shared, not copied.
class TopicInput : public FrameInput {
 public:
  TopicInput(ros::NodeHandle handle, const VisionParameters& parameters);
  ReadResult take(Frame& frame, double timeout) override;
  SourceStatistics statistics() const override;
  std::uint64_t dropped() const override;
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
