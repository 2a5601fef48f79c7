#include "vision_messages.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "vibe_vision/record/track_table.hpp"

namespace vibe::vision {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

bool allTracked(const std::vector<JointSample>& samples) {
  return std::all_of(samples.begin(), samples.end(), [](const JointSample& s) { return s.tracked(); });
}

vibe_msgs::InstrumentTrack makeTrack(const InstrumentConfig& instrument, const Measurement& measurement,
                                     const JointSample& sample) {
  vibe_msgs::InstrumentTrack track;
  track.name = instrument.name;
  track.tracked = sample.tracked();
  track.reason = static_cast<std::uint8_t>(sample.reason);
  track.slide = sample.slide;
  track.rotation = sample.rotation;
  const double nothing = sample.tracked() ? 0 : kNaN;
  track.covariance = {sample.variance[0] + nothing, sample.covariance + nothing, sample.covariance + nothing,
                      sample.variance[1] + nothing};
  track.score = sample.tracked() ? measurement.score : 0;
  track.visible = measurement.visible;
  track.pixel_x = measurement.pixel.x() + nothing;
  track.pixel_y = measurement.pixel.y() + nothing;
  track.pixel_deviation = std::sqrt(measurement.along_variance) + nothing;
  track.scale = measurement.scale + nothing;
  track.reacquired = sample.tracked() && measurement.reacquired;
  return track;
}

void addJoint(const std::string& name, double position, double velocity, sensor_msgs::JointState& message) {
  message.name.push_back(name);
  message.position.push_back(position);
  message.velocity.push_back(velocity);
}

/// Joints with the values of `estimates`, which gives a position and a velocity of an instrument's slide or rotation.
template <class Estimates>
sensor_msgs::JointState makeJoints(const VisionConfig& config, double time, const Estimates& estimates) {
  sensor_msgs::JointState message;
  message.header.stamp = toStamp(time);
  for (std::size_t i = 0; i < config.instruments.size(); ++i) {
    const InstrumentConfig& instrument = config.instruments[i];
    const auto [slide, speed] = estimates(i, false);
    addJoint(instrument.slide_joint, slide, speed, message);
    if (instrument.rotation_joint.empty()) continue;
    const auto [rotation, angular_speed] = estimates(i, true);
    addJoint(instrument.rotation_joint, rotation, angular_speed, message);
  }
  return message;
}

std::pair<double, double> measuredOf(const JointSample& sample, bool rotation) {
  if (rotation) return {sample.rotation, sample.rotation_motion.mean(1)};
  return {sample.slide, sample.slide_motion.mean(1)};
}

}  // namespace

ros::Time toStamp(double time) {
  return ros::Time().fromNSec(static_cast<std::uint64_t>(std::llround(time * 1e9)));
}

vibe_msgs::InstrumentTrackArray makeTracks(const VisionConfig& config, const Frame& frame,
                                           const Measurements& measurements, const std::vector<JointSample>& samples,
                                           const std::string& frame_id, const StageTimes& times) {
  vibe_msgs::InstrumentTrackArray message;
  message.header.stamp = toStamp(frame.stamp);
  message.header.frame_id = frame_id;
  message.frame_sequence = frame.sequence;
  message.exposure = frame.exposure;
  for (std::size_t i = 0; i < samples.size(); ++i)
    message.instruments.push_back(makeTrack(config.instruments[i], measurements[i], samples[i]));
  message.transport = times.transport;
  message.wait = times.wait;
  message.track = times.track;
  message.publish = times.publish;
  return message;
}

vibe_msgs::InstrumentDoubts makeDoubts(const VisionConfig& config, const Frame& frame, const Measurements& measurements,
                                       const std::string& frame_id) {
  vibe_msgs::InstrumentDoubts message;
  message.header.stamp = toStamp(frame.stamp);
  message.header.frame_id = frame_id;
  message.frame_sequence = frame.sequence;
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    message.instruments.push_back(config.instruments[i].name);
    message.doubts.emplace_back(measurements[i].tracked() ? toWord(measurements[i].doubt) : "");
  }
  return message;
}

std::optional<sensor_msgs::JointState> makeMeasuredJoints(const VisionConfig& config, double time,
                                                          const std::vector<JointSample>& samples) {
  if (!allTracked(samples)) return std::nullopt;
  return makeJoints(config, time, [&](std::size_t i, bool rotation) { return measuredOf(samples[i], rotation); });
}

std::optional<sensor_msgs::JointState> makeHeldJoints(const VisionConfig& config, double time,
                                                      const std::vector<JointSample>& samples,
                                                      std::vector<double>& last) {
  const bool any = std::any_of(samples.begin(), samples.end(), [](const JointSample& s) { return s.tracked(); });
  if (!any || (last.empty() && !allTracked(samples))) return std::nullopt;
  std::size_t joint = 0;
  const auto valueOf = [&](std::size_t i, bool rotation) {
    const std::size_t k = joint++;
    return samples[i].tracked() ? measuredOf(samples[i], rotation) : std::make_pair(last[k], kNaN);
  };
  sensor_msgs::JointState message = makeJoints(config, time, valueOf);
  last = message.position;
  return message;
}

std::optional<sensor_msgs::JointState> makePredictedJoints(const VisionConfig& config, double time, double lead,
                                                           const std::vector<JointSample>& samples) {
  if (!allTracked(samples)) return std::nullopt;
  return makeJoints(config, time + lead, [&](std::size_t i, bool rotation) {
    const MotionEstimate ahead = rotation ? extrapolate(samples[i].rotation_motion, lead, kRotationPrior.jerk)
                                          : extrapolate(samples[i].slide_motion, lead, kSlidePrior.jerk);
    return std::make_pair(ahead.mean(0), ahead.mean(1));
  });
}

}  // namespace vibe::vision
