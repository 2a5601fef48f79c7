#include "track/light_model.hpp"

#include <array>
#include <cmath>

#include "track/square.hpp"

namespace vibe::vision {
namespace {

constexpr std::array<double, 2> kFlicker{100, 120};  // of lamps on 50 and 60 Hz mains [Hz]
// Standard deviations at the beginning and of the random walk from one frame to the next. Design choices.
constexpr double kLevel = 1, kLevelWalk = 1.5e-3;
constexpr double kPlace = 0.3, kPlaceWalk = 1e-3;
constexpr double kAmplitude = 0.03, kAmplitudeWalk = 2e-4;
constexpr double kModel = 1e-3;  // what the model leaves unexplained, relative
constexpr double kLongest = 60;  // after which phases are counted anew [s]

/// Mean of t sin(w t) over an exposure, relative to the mean of cos(w t): what a flicker's slope moves the middle by.
double lever(double frequency, double exposure) {
  const double half = M_PI * frequency * exposure;
  if (half < 1e-3) return 2 * M_PI * frequency * exposure * exposure / 12;
  return exposure / 2 * (1 / half - std::cos(half) / std::sin(half));
}

}  // namespace

void LightModel::reset() {
  started_ = false;
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
  mean_ += gain * (value - h.dot(mean_));
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
  return {h.dot(mean_), h.dot(covariance_ * h)};
}

}  // namespace vibe::vision
