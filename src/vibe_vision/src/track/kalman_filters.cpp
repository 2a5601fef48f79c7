#include "track/kalman_filters.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "track/arithmetic.hpp"

namespace vibe::vision {

namespace {

// The acceleration may change from one limit to the other at about 12 Hz; the jerk keeps its sign for 1 ms.
constexpr double kJerkRate = 25;    // standard deviation of the jerk relative to the greatest acceleration [1/s]
constexpr double kJerkTime = 1e-3;  // [s]

// The density of the jerk follows what is seen: the mean of the squared normalised innovation is to be 1.
constexpr double kLearning = 0.05, kLeast = 0.02, kMost = 4;
constexpr double kSurprise = 9;  // of this, at most, is learnt from one innovation
constexpr double kBreak = 100;   // squared normalised innovation of another motion

constexpr std::array<double, 2> kFlicker{100, 120};  // of lamps on 50 and 60 Hz mains [Hz]
// Standard deviations at the beginning and of the random walk from one frame to the next. Design choices.
constexpr double kLevel = 1, kLevelWalk = 1.5e-3;
constexpr double kPlace = 0.3, kPlaceWalk = 1e-3;
constexpr double kAmplitude = 0.03, kAmplitudeWalk = 2e-4;
constexpr double kModel = 1e-3;  // what the model leaves unexplained, relative
constexpr double kSurpriseMemory = 0.2;
constexpr double kLongest = 60;  // after which phases are counted anew [s]

/// Mean of t sin(w t) over an exposure, relative to the mean of cos(w t): what a flicker's slope moves the middle by.
double lever(double frequency, double exposure) {
  const double half = M_PI * frequency * exposure;
  if (half < 1e-3) return 2 * M_PI * frequency * exposure * exposure / 12;
  return exposure / 2 * (1 / half - std::cos(half) / std::sin(half));
}

}  // namespace

void MotionFilter::start(double time, double value, double variance) {
  started_ = true;
  time_ = time;
  state_.mean << value, 0, 0;
  state_.covariance.setZero();
  state_.covariance.diagonal() << variance, square(max_speed_ / 2), square(max_acceleration_ / 2);
}

MotionFilter::State MotionFilter::predict(double time) const {
  const double dt = std::max(time - time_, 0.0), dt2 = dt * dt, dt3 = dt2 * dt;
  Eigen::Matrix3d f;
  f << 1, dt, dt2 / 2, 0, 1, dt, 0, 0, 1;
  Eigen::Matrix3d q;
  q << dt3 * dt2 / 20, dt2 * dt2 / 8, dt3 / 6, dt2 * dt2 / 8, dt3 / 3, dt2 / 2, dt3 / 6, dt2 / 2, dt;
  State later;
  later.mean = f * state_.mean;
  later.covariance =
      f * state_.covariance * f.transpose() + activity_ * square(kJerkRate * max_acceleration_) * kJerkTime * q;
  const double travel = max_speed_ * dt;
  later.mean[0] = std::clamp(later.mean[0], state_.mean[0] - travel, state_.mean[0] + travel);
  later.mean[1] = std::clamp(later.mean[1], -max_speed_, max_speed_);
  later.mean[2] = std::clamp(later.mean[2], -max_acceleration_, max_acceleration_);
  return later;
}

bool MotionFilter::update(double time, double value, double variance) {
  const State predicted = predict(time);
  const double surprise = square(value - predicted.mean[0]) / (predicted.covariance(0, 0) + variance);
  if (surprise > kBreak) {  // a stop or a push: what was known about the motion does not hold any more
    const double dt = time - time_, last = state_.mean[0];
    start(time, value, variance);
    state_.mean[1] = (value - last) / dt;
    state_.covariance(1, 1) = square(max_acceleration_ * dt / 2);
    return true;
  }
  activity_ = std::clamp(activity_ * std::exp(kLearning * (std::min(surprise, kSurprise) - 1)), kLeast, kMost);
  const Eigen::Vector3d gain = predicted.covariance.col(0) / (predicted.covariance(0, 0) + variance);
  Eigen::Matrix3d keep = Eigen::Matrix3d::Identity();
  keep.col(0) -= gain;  // Joseph form: stays symmetric and positive
  time_ = time;
  state_.mean = predicted.mean + gain * (value - predicted.mean[0]);
  state_.covariance = keep * predicted.covariance * keep.transpose() + variance * gain * gain.transpose();
  return false;
}

void LightModel::reset() {
  started_ = false;
  surprise_ = 1;
  mean_.setZero();
  covariance_.setZero();
  covariance_.diagonal() << square(kLevel), square(kPlace), square(kPlace), square(kAmplitude), square(kAmplitude),
      square(kAmplitude), square(kAmplitude);
}

void LightModel::update(double time, double place, double brightness, double deviation) {
  if (!(brightness > 0) || (started_ && std::abs(time - start_) > kLongest)) reset();
  if (!(brightness > 0)) return;
  const double value = std::log(brightness);
  if (!started_) start_ = time, mean_[0] = value, started_ = true;
  covariance_.diagonal().array() += square(kAmplitudeWalk);
  covariance_(0, 0) += square(kLevelWalk);
  covariance_(1, 1) += square(kPlaceWalk);
  covariance_(2, 2) += square(kPlaceWalk);
  Vector h;
  h << 1, place, place * place, 0, 0, 0, 0;
  for (std::size_t i = 0; i < kFlicker.size(); ++i) {
    const double phase = 2 * M_PI * kFlicker[i] * (time - start_);
    h[3 + 2 * static_cast<int>(i)] = std::cos(phase);
    h[4 + 2 * static_cast<int>(i)] = std::sin(phase);
  }
  const double variance = square(deviation) + square(kModel);
  const Vector ph = covariance_ * h;
  const Vector gain = ph / (h.dot(ph) + variance);
  const double innovation = value - h.dot(mean_);
  surprise_ += kSurpriseMemory * (square(innovation) / (h.dot(ph) + variance) - surprise_);
  mean_ += gain * innovation;
  covariance_ -= gain * ph.transpose();
  covariance_ = (covariance_ + covariance_.transpose().eval()) / 2;
}

LightModel::Delay LightModel::delay(double time, double exposure) const {
  Vector h = Vector::Zero();
  for (std::size_t i = 0; i < kFlicker.size(); ++i) {
    const double phase = 2 * M_PI * kFlicker[i] * (time - start_), arm = lever(kFlicker[i], exposure);
    h[3 + 2 * static_cast<int>(i)] = -std::sin(phase) * arm;
    h[4 + 2 * static_cast<int>(i)] = std::cos(phase) * arm;
  }
  return {h.dot(mean_), h.dot(covariance_ * h) * std::max(surprise_, 1.0)};
}

}  // namespace vibe::vision
