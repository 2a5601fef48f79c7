#pragma once

#include <vector>

#include <image_transport/image_transport.h>
#include <ros/ros.h>

#include "vibe_vision/predict/frame_pipeline.hpp"
#include "vision_parameters.hpp"

namespace vibe::vision {

/// Publishes what is known about a frame: docs/interfaces.md, "Topics of the camera". Images only if somebody listens.
class VisionPublisher {
 public:
  VisionPublisher(ros::NodeHandle handle, const VisionConfig& config, const VisionParameters& parameters);

  /// @return when it was published [s]
  double publish(const FrameResult& result);
  /// Without an image: only suturing_device/tracking and suturing_device/doubts.
  void publishSilence(const FrameResult& result);
  void reset() { held_.clear(); }

 private:
  VisionConfig config_;
  VisionParameters parameters_;
  image_transport::ImageTransport transport_;
  ros::Publisher measured_, predicted_, tracking_, doubts_, camera_info_;
  image_transport::Publisher image_, debug_;
  std::vector<double> held_;  // positions of all joints as published last, for hold_lost
  double next_debug_ = 0;     // when the next debug image is due, steady clock [s]

  double publishTracks(const FrameResult& result);
  void publishJoints(const FrameResult& result);
  void publishCamera(const FrameResult& result);
  void publishDebug(const FrameResult& result);
};

}  // namespace vibe::vision
