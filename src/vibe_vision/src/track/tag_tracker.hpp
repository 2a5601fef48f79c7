#pragma once

#include "track/axis_map.hpp"
#include "track/outcome.hpp"
#include "vibe_vision/tag/tag_reader.hpp"

namespace vibe::vision {

/// Follows one instrument that has a tag of another library. Each frame: read the tag in a window around the
/// prediction; if it is not there, in the band around the axis.
class TagTracker {
 public:
  /// @param instrument  its marker is a tag
  TagTracker(const VisionConfig& config, const InstrumentConfig& instrument, const TrackerPolicy& policy);

  /// @param frame  an image of the calibration's sensor
  const Measurement& track(const Frame& frame);
  /// There is no usable frame.
  const Measurement& lose(LostReason reason);
  const Measurement& measurement() const { return measurement_; }
  CalibrationDoubts& doubts() { return doubts_; }
  void reset();

 private:
  /// A tag against the axis.
  struct Look {
    TagPlace place;
    double along = 0, lateral = 0;  ///< of its centre [px]
    double size = 1, tilt = 0;      ///< against the calibrated ones; the tilt to the nearest quarter turn [rad]
    double shear = 0;               ///< along the axis, per pixel across it
    double contrast = 0;            ///< white - black [DN]
    double corner_variance = 0;     ///< of a corner, in one direction [px^2]
  };
  bool search(const Frame& frame, double from, double to, const MotionFilter::State* prediction);
  PixelWindow band(double from, double to) const;
  Look lookAt(const Frame& frame, const TagCorners& corners, const Eigen::Vector2d& shift) const;
  double contrastOf(const Frame& frame, const TagPlace& place) const;
  LostReason judge(const Look& look) const;
  void accept(const Frame& frame, const Look& look, bool reacquired);
  void stateDoubts(const Frame& frame, const Look& look, const MotionFilter::State& state);
  LostReason whyNothing(const Frame& frame) const;

  CameraModel camera_;
  TrackerPolicy policy_;
  GateConfig limits_;
  InstrumentConfig config_;
  TagDesign tag_;
  TagReader reader_;
  Reach reach_;
  CalibrationDoubts doubts_;
  MotionFilter slide_;
  double last_slide_ = 0;
  LostReason reason_ = LostReason::NotFound;
  Measurement measurement_;
};

}  // namespace vibe::vision
