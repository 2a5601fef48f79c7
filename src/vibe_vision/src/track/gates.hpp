#pragma once

#include "track/marker_fitter.hpp"
#include "vibe_vision/config/vision_config.hpp"
#include "vibe_vision/track/tracker_policy.hpp"

namespace vibe::vision {

/// Decides whether a fit is the marker.
class Gates {
 public:
  Gates(const VisionConfig& config, const InstrumentConfig& instrument, const TrackerPolicy& policy = {});

  /// Everything that one picture tells. @param nominal  what the calibration says about size and tilt there
  /// @param expected  the place agrees with a good prediction
  LostReason judge(const MarkerFit& fit, const FitVector& nominal, bool expected = false) const;

  /// What tells the rotation is seen as well as the rest, and agrees.
  bool showsStripe(const MarkerFit& fit) const;

 private:
  double sureTilt(const MarkerFit& fit) const;

  GateConfig limits_;
  TrackerPolicy policy_;
  double begin_, end_;        ///< along the axis [px]
  double lateral_tolerance_;  ///< [px]
};

}  // namespace vibe::vision
