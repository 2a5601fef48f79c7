#pragma once
#include <Eigen/Core>

namespace vibe::vision {

/// Follows the brightness of a marker from frame to frame, to know how the light changes within an exposure: lamps on
/// the mains flicker at 100 or 120 Hz, and a moving marker that is lit more at the end of the exposure seems to be
/// further on. Kalman filter of ln(brightness): constant, place along the axis (vignetting), two flickers.
class LightModel {
 public:
  LightModel() { reset(); }
  void reset();
  /// @param time        middle of the exposure [s]
  /// @param place       along the axis, about -1 to 1
  /// @param brightness  mean over the exposure, > 0; any unit
  /// @param deviation   standard deviation relative to it
  void update(double time, double place, double brightness, double deviation);

  /// By how much the light's middle of an exposure is after its true middle [s].
  struct Delay {
    double mean = 0, variance = 0;  ///< [s], [s^2]
  };
  Delay delay(double time, double exposure) const;

 private:
  static constexpr int kStates = 7;  ///< constant, place, place^2, cosine and sine of two flickers
  using Vector = Eigen::Matrix<double, kStates, 1>;
  using Matrix = Eigen::Matrix<double, kStates, kStates>;

  Vector mean_;
  Matrix covariance_;
  double start_ = 0;  ///< of the flickers' phases [s]
  bool started_ = false;
};

}  // namespace vibe::vision
