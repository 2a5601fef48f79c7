#pragma once

#include <cmath>

#include <Eigen/Core>

namespace vibe::vision {

/// Kalman filter of one coordinate with constant acceleration, driven by white jerk (Bar-Shalom, Li, Kirubarajan,
/// "Estimation with Applications to Tracking and Navigation", 2001, section 6.2.3). It says where to look in the next
/// frame; what is reported is the measurement itself.
class MotionFilter {
 public:
  /// Limits of the coordinate's motion [unit/s], [unit/s^2].
  MotionFilter(double max_speed, double max_acceleration)
      : max_speed_(max_speed), max_acceleration_(max_acceleration) {}

  struct State {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    double deviation() const { return std::sqrt(covariance(0, 0)); }
  };

  bool started() const { return started_; }
  double time() const { return time_; }  ///< of the last measurement [s]
  void reset() { started_ = false; }
  void start(double time, double value, double variance);
  /// @return true if what was known of the motion does not explain it: it begins anew
  bool update(double time, double value, double variance);
  /// At a time not before the last measurement; velocity and acceleration stay within the limits.
  State predict(double time) const;

 private:
  double max_speed_, max_acceleration_;
  double activity_ = 1;  ///< density of the jerk relative to the greatest
  bool started_ = false;
  double time_ = 0;
  State state_;
};

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
  /// Squared normalised innovation, averaged over the last frames: 1 if the light changes as the model expects.
  double surprise() const { return surprise_; }

 private:
  static constexpr int kStates = 7;  ///< constant, place, place^2, cosine and sine of two flickers
  using Vector = Eigen::Matrix<double, kStates, 1>;
  using Matrix = Eigen::Matrix<double, kStates, kStates>;

  Vector mean_;
  Matrix covariance_;
  double start_ = 0;  ///< of the flickers' phases [s]
  double surprise_ = 1;
  bool started_ = false;
};

}  // namespace vibe::vision
