#pragma once

#include <Eigen/Core>

namespace vibe::vision {

/// Jerk as a first-order Gauss-Markov process. For a short correlation time it is white with the spectral density
/// 2 deviation^2 time.
struct JerkModel {
  double deviation;  ///< standard deviation [unit/s^3], > 0
  double time;       ///< correlation time [s], > 0
};

/// By how much position, velocity, acceleration and jerk change in dt [s] per unit of jerk at its beginning:
///   T^3 (1 - x + x^2/2 - e^-x),  T^2 (x - 1 + e^-x),  T (1 - e^-x),  e^-x   with x = dt / T
Eigen::Vector4d jerkResponse(double dt, double correlation_time);
/// Of (position, velocity, acceleration, jerk).
Eigen::Matrix4d motionTransition(double dt, double correlation_time);
/// Covariance that the random part of the jerk adds to (position, velocity, acceleration, jerk) in dt [s]: the integral
/// of 2 deviation^2 / T g(s) g(s)^T with g = jerkResponse(), to a relative 1e-9.
Eigen::Matrix4d jerkNoise(double dt, const JerkModel& jerk);

/// Position, velocity, acceleration and jerk of one coordinate at a time, with their covariance. Units: those of the
/// coordinate ([m] or [rad]) and seconds.
struct MotionEstimate {
  double time = 0;                                       ///< [s]
  Eigen::Vector4d mean = Eigen::Vector4d::Zero();        ///< position, velocity, acceleration, jerk
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();  ///< of the same, in this order
};

/// What the filter believes about a motion that it has not seen.
struct MotionPrior {
  JerkModel jerk;       ///< that disturbs the motion
  double speed;         ///< standard deviation of the first velocity [unit/s], > 0
  double acceleration;  ///< standard deviation of the first acceleration [unit/s^2], > 0
  double max_gap;       ///< without a measurement after which the filter starts anew [s], > 0
};
// Design choices: docs/vision.md, "Prediction".
constexpr MotionPrior kSlidePrior{{80, 0.1}, 0.3, 10, 0.25};       ///< an instrument moved by hand [m]
constexpr MotionPrior kRotationPrior{{6000, 0.1}, 20, 800, 0.25};  ///< a rod turned by hand [rad]

/// Kalman filter with constant acceleration, disturbed by jerk (Bar-Shalom, Li, Kirubarajan, "Estimation with
/// Applications to Tracking and Navigation", 2001, section 6.2.3). The jerk of a hand lasts for some hundredths of a
/// second, so it is a state as well: a first-order Gauss-Markov process, as the acceleration in Singer's model (section
/// 8.2.2 there). Measurements may be missing and unevenly spaced: the process noise is that of the true interval. No
/// memory is allocated.
class Predictor {
 public:
  /// @throws Error if a number of the prior is not finite or not above 0
  explicit Predictor(const MotionPrior& prior);

  /// Takes a measurement. One that is not later than the last is ignored, and so is one that is not finite. After a gap
  /// of more than max_gap the filter starts anew.
  /// @param time      of the measurement [s]
  /// @param variance  of the value [unit^2], > 0
  /// @return whether it was used
  bool update(double time, double value, double variance);
  /// Forgets everything.
  void reset() { started_ = false; }
  /// True before the first measurement.
  bool empty() const { return !started_; }
  /// Call only if not empty(). @param time  [s]; before the last measurement, the estimate at that is returned
  MotionEstimate predict(double time) const;

 private:
  MotionPrior prior_;
  MotionEstimate state_;
  bool started_ = false;

  void start(double time, double value, double variance);
};

/// Extrapolates an estimate by dt >= 0 [s].
MotionEstimate extrapolate(const MotionEstimate& estimate, double dt, const JerkModel& jerk);

}  // namespace vibe::vision
