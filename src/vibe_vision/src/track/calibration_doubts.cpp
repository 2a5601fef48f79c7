#include "track/calibration_doubts.hpp"

#include <cmath>

#include "track/arithmetic.hpp"

namespace vibe::vision {
namespace {

// Design choices.
constexpr double kMemory = 0.99;        // of a picture that is looked at
constexpr double kSignificant = 6;      // standard deviations
constexpr double kLeastRowTime = 1e-6;  // [s]; a row in 10 us is usual
constexpr double kSizeMemory = 0.05;
constexpr int kEnoughSizes = 30;
constexpr double kWrongSize = 0.02;  // prints are right to 0.5 %

}  // namespace

void CalibrationDoubts::addShear(const Shear& shear, double speed, double rows) {
  if (!(shear.variance > 0)) return;
  const double per_time = speed * rows;
  squares_ = kMemory * squares_ + square(per_time) / shear.variance;
  products_ = kMemory * products_ + per_time * shear.value / shear.variance;
}

void CalibrationDoubts::addSize(double log_scale) {
  log_scale_ = sizes_ == 0 ? log_scale : log_scale_ + kSizeMemory * (log_scale - log_scale_);
  ++sizes_;
}

double CalibrationDoubts::rowTime() const {
  if (squares_ <= 0) return 0;
  const double time = products_ / squares_;
  return std::abs(time) > kLeastRowTime && std::abs(time) * std::sqrt(squares_) > kSignificant ? time : 0;
}

Doubt CalibrationDoubts::doubt() const {
  if (rowTime() != 0) return Doubt::Shutter;
  return sizes_ >= kEnoughSizes && std::abs(log_scale_) > kWrongSize ? Doubt::Size : Doubt::None;
}

/// Nobody tells which row the stamp is of: each is as likely.
double CalibrationDoubts::shutterError(double speed, int height) const {
  return std::abs(speed * rowTime()) * height / std::sqrt(3.0);
}

}  // namespace vibe::vision
