#pragma once
#include "track/pattern_fit.hpp"
#include "vibe_vision/config/vision_config.hpp"

namespace vibe::vision {

/// What changes little from frame to frame: size, tilt, aspect, slant, blur of the marker and the slope of the light.
/// Each frame estimates it along with the position, from what is known from the frames before: then it costs the
/// position no accuracy. Values are deviations from those that the calibrated axis gives.
class SlowState {
 public:
  SlowState(const VisionConfig& config, const InstrumentConfig& instrument,
            const std::array<bool, kPoseParameters>& shown);

  /// Forgets what was learnt.
  void reset();
  /// @param travel  since the last frame [px]
  void predict(double travel);
  /// Takes over what a fit found. @param slide  of the marker in that frame [m]
  /// @param doubt  share of the first uncertainty that remains, since the fit may be a neighbour of the best one
  void update(const FitVector& x, const FitMatrix& covariance, double slide, double doubt);

  /// For a fit near this slide [m].
  FitPrior prior(double slide) const;
  /// What the calibration and the axis say about a marker there; position and light are 0.
  FitVector nominal(double slide) const;

 private:
  double greatestSlant() const;
  void limitKeystone();

  SlideAxis axis_;
  double focal_ = 0, slant_ = 0, blur_ = 0, gamma_ = 1, lateral_tolerance_;
  std::array<int, kFitParameters> index_{};  ///< the slow parameters
  int count_ = 0;
  FitVector initial_deviation_, drift_, mean_;
  FitMatrix covariance_;
};

}  // namespace vibe::vision
