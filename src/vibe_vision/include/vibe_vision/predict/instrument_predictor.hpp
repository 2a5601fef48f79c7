#pragma once
#include "vibe_vision/config/vision_config.hpp"
#include "vibe_vision/predict/predictor.hpp"
#include "vibe_vision/track/measurement.hpp"

namespace vibe::vision {

/// What one frame says about the joints of one instrument: as measured, and as the predictors know them.
struct JointSample {
  LostReason reason = LostReason::NoFrame;
  bool has_rotation = false;
  double slide = 0, rotation = 0;                ///< measured [m], [rad]; NaN if lost or not shown
  double variance[2] = {0, 0};                   ///< of slide and rotation [m^2], [rad^2]
  double covariance = 0;                         ///< of slide with rotation [m rad]
  MotionEstimate slide_motion, rotation_motion;  ///< at the stamp of the frame; only if tracked

  bool tracked() const { return reason == LostReason::None; }
};

/// Turns measurements of an instrument into positions of its joints, and predicts these. Joint = sign * measured value
/// + offset, as configured.
class InstrumentPredictor {
 public:
  explicit InstrumentPredictor(const InstrumentConfig& instrument);

  /// Takes a measurement. @param time  of the frame [s]
  JointSample update(double time, const Measurement& measurement);
  void reset();

 private:
  double slide_sign_, slide_offset_, rotation_sign_, rotation_offset_;
  bool has_rotation_;
  Predictor slide_{kSlidePrior}, rotation_{kRotationPrior};
};

}  // namespace vibe::vision
