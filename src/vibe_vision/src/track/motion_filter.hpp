#pragma once
#include <Eigen/Core>
#include <cmath>

namespace vibe::vision {

/// Kalman filter of one coordinate with constant acceleration, driven by white jerk (Bar-Shalom, Li, Kirubarajan,
/// "Estimation with Applications to Tracking and Navigation", 2001, section 6.2.3). It says where to look in the next
/// frame; what is reported is the measurement itself.
class MotionFilter {
 public:
  /// Limits of the coordinate's motion [unit/s], [unit/s^2].
  MotionFilter(double max_speed, double max_acceleration);

  struct State {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    double deviation() const { return std::sqrt(covariance(0, 0)); }
  };

  bool started() const { return started_; }
  double time() const { return time_; }  ///< of the last measurement [s]
  void reset() { started_ = false; }
  void start(double time, double value, double variance);
  void update(double time, double value, double variance);
  /// At a time not before the last measurement; velocity and acceleration stay within the limits.
  State predict(double time) const;

 private:
  double max_speed_, max_acceleration_;
  double activity_ = 1;  ///< density of the jerk relative to the greatest
  bool started_ = false;
  double time_ = 0;
  State state_;
};

}  // namespace vibe::vision
