#pragma once
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/JointState.h>
#include <vibe_msgs/InstrumentDoubts.h>
#include <vibe_msgs/InstrumentTrackArray.h>

#include <optional>
#include <string>
#include <vector>

#include "vibe_vision/predict/frame_pipeline.hpp"

namespace vibe::vision {

ros::Time toStamp(double time);  ///< @param time  Unix time [s], to the nearest nanosecond

/// For suturing_device/tracking. @param samples  of the joints, by instrument
vibe_msgs::InstrumentTrackArray makeTracks(const VisionConfig& config, const Frame& frame,
                                           const Measurements& measurements, const std::vector<JointSample>& samples,
                                           const std::string& frame_id, const StageTimes& times);

/// For suturing_device/doubts, beside the message of makeTracks() for the same frame.
vibe_msgs::InstrumentDoubts makeDoubts(const VisionConfig& config, const Frame& frame, const Measurements& measurements,
                                       const std::string& frame_id);

/// For suturing_device/input/joint_states: positions as measured, velocities as filtered. Nothing unless all
/// instruments are tracked: a message has all joints, and none of them may be made up.
std::optional<sensor_msgs::JointState> makeMeasuredJoints(const VisionConfig& config, double time,
                                                          const std::vector<JointSample>& samples);
/// The same with the last positions of instruments that are lost, velocity NaN. Nothing unless one is tracked and all
/// have been.
/// @param last  positions of all joints as published last; empty before that. Updated
std::optional<sensor_msgs::JointState> makeHeldJoints(const VisionConfig& config, double time,
                                                      const std::vector<JointSample>& samples,
                                                      std::vector<double>& last);
/// For suturing_device/predicted_js: where the joints will be, stamped with that time. Nothing unless all are tracked.
std::optional<sensor_msgs::JointState> makePredictedJoints(const VisionConfig& config, double time, double lead,
                                                           const std::vector<JointSample>& samples);

/// Camera matrix and distortion of the configuration, region of interest and stamp of the frame.
sensor_msgs::CameraInfo makeCameraInfo(const CameraModel& camera, const Frame& frame, const std::string& frame_id);
sensor_msgs::ImagePtr makeImage(const Frame& frame, const std::string& frame_id);

/// JPEG or PNG as a grey image with the same header. @throws Error with one sentence if it cannot be decoded
sensor_msgs::ImagePtr makeImage(const sensor_msgs::CompressedImage& message);

/// How many bits of 16-bit grey values a camera uses. Messages do not say, and cameras of 10, 12 or 14 bits leave the
/// upper ones 0: the fewest that have room for every value seen so far.
struct SampleDepth {
  int bits = 8;
};

/// An image message as a frame that shares its pixels (mono8), or holds a grey copy (any other encoding).
/// @param exposure       [s]
/// @param start_stamped  the stamp is the start of the exposure, not its middle
/// @param depth  of the camera, learnt from 16-bit images
/// @throws Error with one sentence for a stamp 0, an encoding that cannot be read, binning, or sizes that contradict
///         each other
Frame makeFrame(const sensor_msgs::ImageConstPtr& image, const sensor_msgs::CameraInfo& info, double exposure,
                bool start_stamped, SampleDepth& depth);

}  // namespace vibe::vision
