#include "vision_parameters.hpp"

#include <ros/param.h>

#include <vector>

#include "vibe_core/program/error.hpp"
#include "vibe_ros_utils/parameter_reader.hpp"

namespace vibe::vision {
namespace {

constexpr int kMaxPixels = 20000;  // per side of a sensor
constexpr StampPoint kPoints[] = {StampPoint::ExposureStart, StampPoint::ExposureEnd};
constexpr CameraClock kClocks[] = {CameraClock::Auto, CameraClock::Free, CameraClock::Host};

/// One of some words. @return its index; the first is the default
std::size_t readChoice(ros_utils::ParameterReader& reader, const std::string& name,
                       const std::vector<std::string>& words) {
  std::string word = words.front();
  reader.read(name, word);
  std::string all;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == word) return i;
    all += (i == 0 ? "" : i + 1 < words.size() ? ", " : " or ") + words[i];
  }
  throw Error("Parameter ~" + name + " is '" + word + "'; set it to " + all + ".");
}

void readCamera(ros_utils::ParameterReader& reader, SourceOptions& options) {
  reader.read("exposure", options.exposure, 1e-6, 1, "s");
  reader.read("rate", options.rate, 0.1, 10000, "Hz");
  reader.read("gain", options.gain, -1, 100, "dB");
  reader.read("roi_x", options.roi_x, 0, kMaxPixels);
  reader.read("roi_y", options.roi_y, 0, kMaxPixels);
  reader.read("roi_width", options.roi_width, 0, kMaxPixels);
  reader.read("roi_height", options.roi_height, 0, kMaxPixels);
  reader.read("loop", options.loop);
  options.stamp_point = kPoints[readChoice(reader, "camera_stamp", {"start_of_exposure", "end_of_exposure"})];
  options.clock = kClocks[readChoice(reader, "camera_clock", {"auto", "free", "host"})];
  reader.read("pixel_format", options.pixel_format);
  reader.read("packet_size", options.packet_size, 0, 65535);
  reader.read("realtime_priority", options.realtime_priority, 0, 99);
  options.paced = true;  // nobody waits for the node: frames that come faster than real time are dropped
}

void checkTime(const VisionParameters& parameters) {
  bool use_sim_time = false;
  ros::param::get("/use_sim_time", use_sim_time);
  if (!use_sim_time || parameters.fromTopic()) return;
  throw Error(
      "A camera is stamped in wall time, but /use_sim_time is true; run 'rosparam delete /use_sim_time' before any "
      "node "
      "starts, or use images of a topic.");
}

}  // namespace

VisionParameters readVisionParameters(const ros::NodeHandle& private_handle) {
  ros_utils::ParameterReader reader(private_handle);
  VisionParameters parameters;
  parameters.config = reader.required("config", "the configuration of the rig, a file or package:// address");
  parameters.source =
      reader.required("source", "the address of a camera, for example gige: or video:FILE, or to topic");
  readCamera(reader, parameters.options);
  parameters.start_stamped = readChoice(reader, "image_stamp", {"middle_of_exposure", "start_of_exposure"}) == 1;
  reader.read("udp", parameters.udp);
  reader.read("lead", parameters.lead, 0, 0.2, "s");
  reader.read("frame_id", parameters.frame_id);
  reader.read("hold_lost", parameters.hold_lost);
  reader.read("debug_rate", parameters.debug_rate, 0.1, 1000, "Hz");
  reader.read("publish_images", parameters.publish_images);
  parameters.compressed = readChoice(reader, "image_transport", {"raw", "compressed"}) == 1;
  double diagnostic_period = 1;  // diagnostic_updater reads it itself
  reader.read("diagnostic_period", diagnostic_period, 0.1, 60, "s");
  reader.finish();
  checkTime(parameters);
  return parameters;
}

}  // namespace vibe::vision
