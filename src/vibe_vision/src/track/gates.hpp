#pragma once

#include "track/kalman_filters.hpp"
#include "track/marker_fitter.hpp"
#include "vibe_vision/config/vision_config.hpp"

namespace vibe::vision {

/// Decides whether a fit is the marker.
class Gates {
 public:
  Gates(const VisionConfig& config, const InstrumentConfig& instrument);

  /// Everything that one picture tells. @param nominal  what the calibration says about size and tilt there
  /// @param expected  the place agrees with a good prediction
  LostReason judge(const MarkerFit& fit, const FitVector& nominal, bool expected = false) const;
  /// Whether an instrument that was seen some time ago can be there. @param dt  since then [s]
  bool isReachable(double slide, const MotionFilter::State& predicted, double last_slide, double dt) const;

 private:
  GateConfig limits_;
  MotionLimits motion_;
  double begin_, end_;        ///< along the axis [px]
  double lateral_tolerance_;  ///< [px]
};

}  // namespace vibe::vision
