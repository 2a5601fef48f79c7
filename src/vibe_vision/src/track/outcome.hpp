#pragma once

#include <array>
#include <memory>

#include "track/calibration_doubts.hpp"
#include "track/kalman_filters.hpp"
#include "vibe_vision/track/tracker_policy.hpp"

namespace vibe::vision {

/// What the pixels tell in which a marker was looked for.
struct BandLight {
  bool in_view = false;  ///< there are any
  double saturated = 0;  ///< share of them
  double brightest = 0;  ///< [DN]
};
LostReason whyNothing(const BandLight& light, double min_contrast, const TrackerPolicy& policy);

/// The shift of a blurred marker's middle against its place at the middle of the exposure, per unit of acceleration:
/// the mean of t^2 / 2 over the exposure.
inline double exposureShift(double exposure) {
  return exposure * exposure / 24;
}

/// Whether what is followed may be a copy of the marker. What moves is the marker. What rests while something else
/// looks like it, too, or what was found elsewhere after the marker was lost, is in doubt until it moves; and what has
/// not moved yet is unchecked: the marker may be hidden while a copy of it is seen.
class Copies {
 public:
  explicit Copies(const TrackerPolicy& policy) : policy_(policy) {}
  void reset() { *this = Copies(policy_); }
  /// A search found what is followed from now on [px along the axis]. @param lost  it was not seen before
  void find(double along, bool lost);
  void follow(double along);
  bool doubted() const { return !moved_ && (suspect_ || count_ > 0); }
  bool unchecked() const { return !moved_; }
  /// Something that is not followed looks like the marker there.
  void see(double along);
  /// What was seen from one place to another, but for what may be hidden by the marker.
  void forget(double from, double to, double own, double apart);
  bool isAt(double along) const;

 private:
  TrackerPolicy policy_;
  bool known_ = false, moved_ = false, suspect_ = false;
  double anchor_ = 0, along_ = 0;
  std::array<double, 4> places_{};
  std::size_t count_ = 0;
};

/// Where an instrument can be. Frames in a row that agree on a place out of reach are believed: somebody moved it.
class Reach {
 public:
  Reach(double max_speed, const TrackerPolicy& policy) : max_speed_(max_speed), policy_(policy) {}

  /// A stop ends a motion at once: from where it was, only the speed is limited. @param dt  since then [s]
  bool contains(double slide, const MotionFilter::State& predicted, double last_slide, double dt) const;
  /// @return false if a place in a frame is out of reach and not believed yet
  bool believes(double slide, double stamp, const MotionFilter::State& predicted, double last_slide, double dt);
  bool jumped() const { return jumps_ >= policy_.jumps_to_believe; }
  void settle() { jumps_ = 0; }

 private:
  double max_speed_;  ///< [m/s]
  TrackerPolicy policy_;
  int jumps_ = 0;  ///< frames in a row that show the marker where it cannot be
  double jump_slide_ = 0, jump_stamp_ = 0;
};

/// Follows the marker of one instrument: what trackers of all markers have in common.
class MarkerTracker {
 public:
  MarkerTracker(const InstrumentConfig& instrument, const TrackerPolicy& policy);
  virtual ~MarkerTracker() = default;

  /// @param frame  an image of the calibration's sensor
  virtual const Measurement& track(const Frame& frame) = 0;
  /// There is no usable frame.
  virtual const Measurement& lose(LostReason reason);
  virtual void reset();
  virtual void setNoise(const PixelNoise& /*noise*/) {}
  virtual double ink() const { return 0; }  ///< of the print, as far as it was learnt [m]
  const Measurement& measurement() const { return measurement_; }
  CalibrationDoubts& doubts() { return doubts_; }

 protected:
  /// States the doubt of a tracked instrument, and widens its variance by that of the shutter. As long as nobody knows
  /// whether all rows are exposed at the same time, what moves fast may be elsewhere.
  /// @param scale  [px/m]. @param height  of the sensor [px]
  void stateDoubts(const MotionFilter::State& state, double scale, int height);

  InstrumentConfig config_;
  TrackerPolicy policy_;
  Reach reach_;
  CalibrationDoubts doubts_;
  MotionFilter slide_;
  double last_slide_ = 0;
  LostReason reason_ = LostReason::NotFound;
  Measurement measurement_;
};

/// For a ring or a sleeve.
std::unique_ptr<MarkerTracker> makeInstrumentTracker(const VisionConfig& config, const InstrumentConfig& instrument,
                                                     const TrackerPolicy& policy);
/// For a tag.
std::unique_ptr<MarkerTracker> makeTagTracker(const VisionConfig& config, const InstrumentConfig& instrument,
                                              const TrackerPolicy& policy);

}  // namespace vibe::vision
