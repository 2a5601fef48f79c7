#pragma once
#include <Eigen/Core>

namespace vibe {

/// Position, velocity and acceleration of one coordinate at a time, with their covariance. Units: those of the
/// coordinate ([m] or [rad]) and seconds.
struct MotionEstimate {
  double time = 0;  ///< [s]
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// Kalman filter with constant acceleration, driven by white jerk (Bar-Shalom, Li, Kirubarajan, "Estimation with
/// Applications to Tracking and Navigation", 2001, section 6.2.3). Measurements may be missing and unevenly spaced.
class Predictor {
 public:
  /// @param jerk_density  spectral density of the jerk [(unit/s^3)^2 s]
  explicit Predictor(double jerk_density);

  /// @param time  of the measurement [s]; one that is not later than the last is ignored
  /// @param variance  of the measured value, > 0
  void update(double time, double value, double variance);
  /// No measurement at that time: the covariance grows. After `max_gap` [s] without one the filter starts anew.
  void reset();
  bool empty() const { return !started_; }
  /// At any time at or after the last measurement. @return the last estimate, extrapolated
  MotionEstimate predict(double time) const;

 private:
  MotionEstimate state_;
  double jerk_density_;
  bool started_ = false;
};

}  // namespace vibe
