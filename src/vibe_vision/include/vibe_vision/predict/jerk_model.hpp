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

}  // namespace vibe::vision
