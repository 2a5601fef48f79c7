#include "vibe_vision/predict/predictor.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "vibe_core/common/error.hpp"

namespace vibe::vision {
namespace {

void checkPositive(double value, const std::string& name) {
  if (std::isfinite(value) && value > 0) return;
  throw Error("The prior of a predictor has " + name + " = " + std::to_string(value) +
              "; set it to a finite number above 0.");
}

double squared(double x) {
  return x * x;
}

}  // namespace

MotionEstimate extrapolate(const MotionEstimate& estimate, double dt, const JerkModel& jerk) {
  if (dt <= 0) return estimate;
  const Eigen::Matrix4d f = motionTransition(dt, jerk.time);
  MotionEstimate later;
  later.time = estimate.time + dt;
  later.mean = f * estimate.mean;
  later.covariance = f * estimate.covariance * f.transpose() + jerkNoise(dt, jerk);
  return later;
}

Predictor::Predictor(const MotionPrior& prior) : prior_(prior) {
  checkPositive(prior.jerk.deviation, "jerk.deviation");
  checkPositive(prior.jerk.time, "jerk.time");
  checkPositive(prior.speed, "speed");
  checkPositive(prior.acceleration, "acceleration");
  checkPositive(prior.max_gap, "max_gap");
}

void Predictor::start(double time, double value, double variance) {
  state_.time = time;
  state_.mean << value, 0, 0, 0;
  state_.covariance.setZero();
  state_.covariance.diagonal() << variance, squared(prior_.speed), squared(prior_.acceleration),
      squared(prior_.jerk.deviation);
  started_ = true;
}

bool Predictor::update(double time, double value, double variance) {
  if (!std::isfinite(time) || !std::isfinite(value) || !std::isfinite(variance) || variance <= 0) return false;
  if (started_ && time <= state_.time) return false;
  if (!started_ || time - state_.time > prior_.max_gap) {
    start(time, value, variance);
    return true;
  }
  const MotionEstimate predicted = predict(time);
  // Joseph form: stays symmetric and positive semidefinite
  const Eigen::Vector4d gain = predicted.covariance.col(0) / (predicted.covariance(0, 0) + variance);
  Eigen::Matrix4d keep = Eigen::Matrix4d::Identity();
  keep.col(0) -= gain;
  state_.time = time;
  state_.mean = predicted.mean + gain * (value - predicted.mean(0));
  state_.covariance = keep * predicted.covariance * keep.transpose() + variance * gain * gain.transpose();
  return true;
}

MotionEstimate Predictor::predict(double time) const {
  return extrapolate(state_, time - state_.time, prior_.jerk);
}

}  // namespace vibe::vision
