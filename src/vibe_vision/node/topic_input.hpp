#pragma once
#include <image_transport/image_transport.h>

#include <condition_variable>
#include <mutex>

#include "frame_input.hpp"
#include "vision_parameters.hpp"

namespace vibe::vision {

/// Images of another node, from the topic `image` with its camera_info. In a nodelet they are shared, not copied.
class TopicInput : public FrameInput {
 public:
  TopicInput(ros::NodeHandle handle, ros::NodeHandle private_handle, const VisionParameters& parameters);
  ReadResult take(Frame& frame, double timeout) override;
  SourceStatistics statistics() const override;
  std::uint64_t dropped() const override;
  std::string status() const override;

 private:
  double exposure_;
  bool start_stamped_;
  mutable std::mutex mutex_;
  std::condition_variable arrived_;
  Frame frame_;
  bool fresh_ = false;
  SourceStatistics statistics_;
  std::uint64_t dropped_ = 0;
  std::uint64_t last_sequence_ = 0;
  std::string topic_, complaint_;
  image_transport::ImageTransport transport_;
  image_transport::CameraSubscriber subscriber_;

  void onImage(const sensor_msgs::ImageConstPtr& image, const sensor_msgs::CameraInfoConstPtr& info);
  void refuse(const std::string& complaint);
  void put(Frame&& frame);
};

}  // namespace vibe::vision
