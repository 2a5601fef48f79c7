#include "vision_publisher.hpp"

#include <cmath>

#include <cv_bridge/cv_bridge.h>
#include <sensor_msgs/image_encodings.h>

#include "vibe_core/clocks/step_timer.hpp"
#include "vibe_core/files/number_text.hpp"
#include "vibe_vision/record/annotation.hpp"
#include "vision_messages.hpp"

namespace vibe::vision {

namespace {

constexpr std::uint32_t kQueue = 10;

std::string describe(const InstrumentConfig& instrument, const Measurement& measurement, const JointSample& sample) {
  if (!sample.tracked()) return instrument.name + ": lost, " + toText(sample.reason);
  std::string line =
      instrument.name + formatted(": %.3f mm +- %.1f um", 1e3 * sample.slide, 1e6 * std::sqrt(sample.variance[0]));
  if (sample.has_rotation) {
    line += formatted(", %.1f deg +- %.2f", sample.rotation * 180 / M_PI, std::sqrt(sample.variance[1]) * 180 / M_PI);
  }
  return line + formatted(", score %.2f", measurement.score);
}

}  // namespace

VisionPublisher::VisionPublisher(ros::NodeHandle handle, const VisionConfig& config, const VisionParameters& parameters)
    : config_(config), parameters_(parameters), transport_(handle) {
  measured_ = handle.advertise<sensor_msgs::JointState>("suturing_device/input/joint_states", kQueue);
  if (parameters.lead > 0)
    predicted_ = handle.advertise<sensor_msgs::JointState>("suturing_device/predicted_js", kQueue);
  tracking_ = handle.advertise<vibe_msgs::InstrumentTrackArray>("suturing_device/tracking", kQueue);
  doubts_ = handle.advertise<vibe_msgs::InstrumentDoubts>("suturing_device/doubts", kQueue);
  if (parameters.publish_images) debug_ = transport_.advertise("debug_image", 1);
  if (parameters.fromTopic()) return;  // the camera's node publishes the other two
  camera_info_ = handle.advertise<sensor_msgs::CameraInfo>("camera_info", kQueue);
  if (parameters.publish_images) image_ = transport_.advertise("image_raw", 1);
}

double VisionPublisher::publish(const FrameResult& result) {
  publishJoints(result);
  const double time = publishTracks(result);
  publishCamera(result);
  publishDebug(result);
  return time;
}

void VisionPublisher::publishSilence(const FrameResult& result) {
  publishTracks(result);
}

void VisionPublisher::publishJoints(const FrameResult& result) {
  const double stamp = result.frame.stamp;
  const auto measured = parameters_.hold_lost ? makeHeldJoints(config_, stamp, result.samples, held_)
                                              : makeMeasuredJoints(config_, stamp, result.samples);
  if (measured) measured_.publish(*measured);
  if (!predicted_) return;
  if (const auto predicted = makePredictedJoints(config_, stamp, parameters_.lead, result.samples))
    predicted_.publish(*predicted);
}

double VisionPublisher::publishTracks(const FrameResult& result) {
  StageTimes times = result.times;
  times.publish = ros::Time::now().toSec() - result.tracked_at;
  const vibe_msgs::InstrumentTrackArray tracks =
      makeTracks(config_, result.frame, result.measurements, result.samples, parameters_.frame_id, times);
  tracking_.publish(tracks);
  doubts_.publish(makeDoubts(config_, result.frame, result.measurements, parameters_.frame_id));
  return times.publish;
}

void VisionPublisher::publishCamera(const FrameResult& result) {
  if (!camera_info_) return;
  camera_info_.publish(makeCameraInfo(config_.camera, result.frame, parameters_.frame_id));
  if (image_.getNumSubscribers() > 0) image_.publish(makeImage(result.frame, parameters_.frame_id));
}

void VisionPublisher::publishDebug(const FrameResult& result) {
  if (debug_.getNumSubscribers() == 0 || steadyTime() < next_debug_) return;
  next_debug_ = steadyTime() + 1 / parameters_.debug_rate;
  cv_bridge::CvImage picture;
  picture.header.stamp = toStamp(result.frame.stamp);
  picture.header.frame_id = parameters_.frame_id;
  picture.encoding = sensor_msgs::image_encodings::BGR8;
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < result.samples.size(); ++i)
    texts.push_back(describe(config_.instruments[i], result.measurements[i], result.samples[i]));
  picture.image = annotate(config_, result.frame, result.measurements, texts);
  debug_.publish(picture.toImageMsg());
}

}  // namespace vibe::vision
