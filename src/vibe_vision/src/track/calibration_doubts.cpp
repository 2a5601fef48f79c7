#include "track/calibration_doubts.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "track/arithmetic.hpp"

namespace vibe::vision {
namespace {

// Design choices.
constexpr double kMemory = 0.99;        // of a picture that is looked at
constexpr double kSignificant = 6;      // standard deviations
constexpr double kLeastRowTime = 1e-6;  // [s]; a row in 10 us is usual
constexpr double kFitMemory = 0.05;
constexpr int kEnoughFits = 30, kEnoughResponses = 3;  // which are looked for only where they explain a picture
constexpr double kWrongSize = 0.02;                    // prints are right to 0.5 %
constexpr double kCurved = 0.1;                        // log of a response that is not the given one
constexpr double kAskew = 0.0125;  // [rad]: 0.7 deg; at 1.5 mm from the axis it moves an edge by 19 um
constexpr double kBent = 0.0015;   // of the radius: a ring of 4 mm on something round of 30 mm
// Standard deviations before any picture: time between rows [s], tilt of a print and of a rod [rad].
constexpr double kUsualRowTime = 2e-5, kUsualAskew = 0.02, kUsualTilt = 0.2;

}  // namespace

void CalibrationDoubts::reset() {
  information_.setZero();
  sums_.setZero();
  bend_weight_ = bend_sum_ = log_scale_ = log_gamma_ = 0;
  fits_ = 0;
  solve();
}

void CalibrationDoubts::solve() {
  Matrix h = information_;
  h.diagonal() +=
      Vector(1 / square(kUsualRowTime), 1 / square(kUsualAskew), 1 / square(kUsualAskew), 1 / square(kUsualTilt));
  covariance_ = h.llt().solve(Matrix::Identity());
  mean_ = covariance_ * sums_;
}

void CalibrationDoubts::add(const Vector& by, double value, double variance) {
  if (!(variance > 0)) return;
  information_ = kMemory * information_ + by * by.transpose() / variance;
  sums_ = kMemory * sums_ + by * value / variance;
  solve();
}

void CalibrationDoubts::addShear(const Distortion& shear, double speed) {
  add(Vector(speed, 0, 0, 0), shear.value, shear.variance);
}

/// A print that is askew on its rod seems to be tilted to one side and, half a turn later, to the other; a rod that is
/// askew always to the same.
void CalibrationDoubts::addShear(const Distortion& shear, double speed, double tilt, double rotation) {
  add(Vector(speed, rows_ * std::cos(rotation), rows_ * std::sin(rotation), rows_), shear.value - rows_ * tilt,
      shear.variance);
}

void CalibrationDoubts::addBend(const Distortion& bend) {
  if (!(bend.variance > 0)) return;
  bend_weight_ = kMemory * bend_weight_ + 1 / bend.variance;
  bend_sum_ = kMemory * bend_sum_ + bend.value / bend.variance;
}

void CalibrationDoubts::addFit(double log_scale, double log_gamma) {
  log_scale_ = fits_ == 0 ? log_scale : log_scale_ + kFitMemory * (log_scale - log_scale_);
  log_gamma_ = fits_ == 0 ? log_gamma : log_gamma_ + kFitMemory * (log_gamma - log_gamma_);
  ++fits_;
}

double CalibrationDoubts::rowTime() const {
  const double time = mean_[0], deviation = std::sqrt(covariance_(0, 0));
  return std::abs(time) > kLeastRowTime && std::abs(time) > kSignificant * deviation ? time : 0;
}

bool CalibrationDoubts::isAskew() const {
  const double tilt = std::hypot(mean_[1], mean_[2]);
  const double variance = covariance_.diagonal().segment<2>(1).maxCoeff();
  return tilt > kAskew && tilt > kSignificant * std::sqrt(variance);
}

Doubt CalibrationDoubts::doubt() const {
  if (rowTime() != 0) return Doubt::Shutter;
  if (fits_ >= kEnoughFits && std::abs(log_scale_) > kWrongSize) return Doubt::Size;
  if (isAskew()) return Doubt::Askew;
  const double bend = bend_weight_ > 0 ? bend_sum_ / bend_weight_ : 0;
  if (std::abs(bend) > kBent && std::abs(bend) * std::sqrt(bend_weight_) > kSignificant) return Doubt::Bent;
  return fits_ >= kEnoughResponses && std::abs(log_gamma_) > kCurved ? Doubt::Response : Doubt::None;
}

/// Nobody tells which row the stamp is of: each is as likely.
double CalibrationDoubts::shutterError(double speed, int height) const {
  return std::abs(speed * rowTime()) * height / std::sqrt(3.0);
}

double CalibrationDoubts::unknownShutterError(double speed, int height) const {
  return std::abs(speed) * std::sqrt(covariance_(0, 0)) * height / std::sqrt(3.0);
}

}  // namespace vibe::vision
