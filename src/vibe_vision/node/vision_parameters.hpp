#pragma once
#include <ros/node_handle.h>

#include <string>

#include "vibe_vision/camera/frame_source.hpp"

namespace vibe::vision {

/// Private parameters of the vision node and nodelet: docs/interfaces.md.
struct VisionParameters {
  std::string config;          ///< file of VisionConfig
  std::string source;          ///< address of a FrameSource, or "topic"
  SourceOptions options;       ///< of the camera; exposure and rate also of a topic
  bool start_stamped = false;  ///< stamps of image messages are the start of the exposure, not its middle
  bool compressed = false;     ///< images of a topic are sensor_msgs/CompressedImage
  std::string udp;             ///< host:port; empty: no datagrams
  double lead = 0;             ///< of suturing_device/predicted_js [s]; 0: not published
  std::string frame_id = "camera_optical";
  bool hold_lost = false;  ///< publish the last position of a lost instrument as long as another one is tracked
  double debug_rate = 15;  ///< of the debug image at most [Hz]
  bool publish_images = true;

  bool fromTopic() const { return source == "topic"; }
};

/// @throws Error for a parameter that is unknown or wrong
VisionParameters readVisionParameters(const ros::NodeHandle& private_handle);

}  // namespace vibe::vision
