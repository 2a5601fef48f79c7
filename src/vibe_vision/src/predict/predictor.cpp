#include "vibe_vision/predict/predictor.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "vibe_core/program/error.hpp"

namespace vibe::vision {

namespace {

// Gauss-Legendre quadrature on [0, 1] with eight points: exact for polynomials of degree 15.
constexpr std::array<double, 4> kAbscissa{0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                                          0.9602898564975363};
constexpr std::array<double, 4> kWeight{0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763};
constexpr double kMaxPieces = 1000;  // of one correlation time each

/// x^n/n! - x^(n+1)/(n+1)! + ...: the rest of the series of e^-x, with the sign that makes it positive.
double expRest(int n, double x) {
  double term = 1;
  for (int k = 1; k <= n; ++k) term *= x / k;
  double sum = 0;
  for (int k = n + 1; std::abs(term) > 1e-18 * std::abs(sum); ++k) {
    sum += term;
    term *= -x / k;
  }
  return sum;
}

double squared(double x) {
  return x * x;
}

}  // namespace

Eigen::Vector4d jerkResponse(double dt, double correlation_time) {
  const double t = correlation_time, x = dt / t, decay = std::exp(-x);
  if (x < 1) return {t * t * t * expRest(3, x), t * t * expRest(2, x), t * expRest(1, x), decay};  // no cancellation
  return {t * t * t * (1 - x + x * x / 2 - decay), t * t * (x - 1 + decay), t * (1 - decay), decay};
}

Eigen::Matrix4d motionTransition(double dt, double correlation_time) {
  Eigen::Matrix4d f = Eigen::Matrix4d::Identity();
  f(0, 1) = f(1, 2) = dt;
  f(0, 2) = dt * dt / 2;
  f.col(3) = jerkResponse(dt, correlation_time);
  return f;
}

Eigen::Matrix4d jerkNoise(double dt, const JerkModel& jerk) {
  const double pieces = std::clamp(std::ceil(dt / jerk.time), 1.0, kMaxPieces);
  const double half = dt / pieces / 2;
  Eigen::Matrix4d q = Eigen::Matrix4d::Zero();
  for (double piece = 0; piece < pieces; ++piece) {
    const double middle = (2 * piece + 1) * half;
    for (std::size_t i = 0; i < kAbscissa.size(); ++i)
      for (const double sign : {-1.0, 1.0}) {
        const Eigen::Vector4d g = jerkResponse(middle + sign * kAbscissa[i] * half, jerk.time);
        q += kWeight[i] * half * g * g.transpose();
      }
  }
  return 2 * jerk.deviation * jerk.deviation / jerk.time * q;
}

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
  const std::pair<const char*, double> numbers[] = {{"jerk.deviation", prior.jerk.deviation},
                                                    {"jerk.time", prior.jerk.time},
                                                    {"speed", prior.speed},
                                                    {"acceleration", prior.acceleration},
                                                    {"max_gap", prior.max_gap}};
  for (const auto& [name, value] : numbers)
    if (!std::isfinite(value) || value <= 0)
      throw Error("The prior of a predictor has " + std::string(name) + " = " + std::to_string(value) +
                  "; set it to a finite number above 0.");
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
