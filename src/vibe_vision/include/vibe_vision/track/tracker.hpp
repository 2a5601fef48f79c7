#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "vibe_vision/config/vision_config.hpp"
#include "vibe_vision/image/frame.hpp"
#include "vibe_vision/track/tracker_policy.hpp"

namespace vibe::vision {

/// Why an instrument has no position. The numbers are those of vibe_msgs/InstrumentTrack and of the datagram: new ones
/// at the end.
enum class LostReason {
  None = 0,        ///< tracked
  NotFound = 1,    ///< nothing in the range of the axis looks like the marker
  Occluded = 2,    ///< too little of the marker is seen
  Saturated = 3,   ///< the image is too bright
  Dark = 4,        ///< the image is too dark
  Mismatch = 5,    ///< something is there, but its pattern, size or tilt is not the marker's
  Jump = 6,        ///< further from the prediction than the instrument can move
  OutOfView = 7,   ///< the axis leaves the image, or its region of interest
  WrongImage = 8,  ///< size or format of the image is not that of the calibration
  NoFrame = 9,     ///< no image
};
const char* toText(LostReason reason);  ///< a sentence for people
/// "not_found", "occluded", ...: the reason as one word for tables; "" if tracked.
const char* toWord(LostReason reason);

/// What speaks against camera or calibration although the marker is tracked, from many frames.
enum class Doubt {
  None,       ///< nothing does
  Size,       ///< the marker is not as large as calibrated
  Shutter,    ///< the rows of an image are not exposed at the same time
  Unchecked,  ///< too few fast frames have been seen to know that, or it has not moved yet and may be a copy
  Askew,      ///< a sleeve is askew on its rod
  Bent,       ///< a flat marker is bent, or the ends of a marker stand off
  Response,   ///< the response of the camera is not the one that was given
  Noise,      ///< the pictures are noisier than was stated
  Oval,       ///< a sleeve is not round
  Exposure,   ///< the motion during the exposure is not as long as speed and exposure say
  Light,      ///< the light changes in a way that is not that of a lamp on the mains
  Rows,       ///< rows of the image do not belong together, or not to this moment
  Copy,       ///< what is followed may be a copy of the marker
  Stripe,     ///< what tells the rotation of a sleeve is hidden or does not fit: the rotation is what was known before
};
const char* toText(Doubt doubt);  ///< a sentence for people, with possible causes; empty for None
const char* toWord(Doubt doubt);  ///< "size", "shutter", ...: one word for tables; empty for None

/// What one frame says about one instrument.
struct Measurement {
  LostReason reason = LostReason::NoFrame;  ///< None: tracked
  double slide = 0;                         ///< [m]; NaN if lost
  double rotation = 0;  ///< turns counted since the first detection [rad]; NaN if lost or not shown by the marker
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< of slide and rotation [m^2, m rad, rad^2]
  double score = 0;                                      ///< 0 to 1: how well the marker explains the pixels; 0 if lost
  double visible = 0;                                    ///< share of the marker's information that was used, 0 to 1

  double along = 0, lateral = 0;                    ///< marker centre relative to SlideAxis::origin, undistorted [px]
  double along_variance = 0;                        ///< [px^2]
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< marker centre in the full image, as seen (distorted) [px]
  double scale = 1;                                 ///< size of the marker relative to the calibrated one
  double tilt = 0;                                  ///< in the image, against the axis [rad]
  double contrast = 0;                              ///< white - black [DN]
  double ink = 0;                                   ///< InstrumentConfig::ink, as far as it was learnt [m]
  int roi_x = 0, roi_y = 0, roi_width = 0, roi_height = 0;  ///< where it was looked for, full image [px]
  bool reacquired = false;                                  ///< found by a search, not near a prediction

  Doubt doubt = Doubt::None;  ///< of a tracked instrument

  bool tracked() const { return reason == LostReason::None; }  ///< false: `reason` says why not
};

/// Of all instruments, in the order of VisionConfig::instruments.
using Measurements = std::vector<Measurement>;

/// Follows all instruments of a rig from frame to frame. Each frame: predict, fit the marker's model to the pixels
/// around the prediction; if that fails a gate, search the axis in the same frame, fit and gate again; else report it
/// as lost. The cost of a tracked frame does not depend on the size of the sensor. Deterministic: the same frames give
/// the same bits. Frames of another size than the camera model's are WrongImage.
///
/// Not thread-safe; use one per thread.
class Tracker {
 public:
  /// @throws Error if the configuration cannot be tracked: see checkMarker()
  /// @param policy  other numbers than the defaults are for experiments
  explicit Tracker(const VisionConfig& config, const TrackerPolicy& policy = {});
  ~Tracker();
  Tracker(Tracker&&) noexcept;  ///< leaves the other unusable
  Tracker& operator=(Tracker&&) noexcept;

  /// A frame with stamp and number of the last one is that one again: it adds nothing.
  /// @return valid until the next call
  const Measurements& track(const Frame& frame);
  /// Forgets where the instruments are; turns of the rotation are kept.
  void reset();
  const VisionConfig& config() const;  ///< as it was given

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vibe::vision
