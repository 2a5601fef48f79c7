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
constexpr int kEnoughFits = 5, kEnoughResponses = 3;  // which are looked for only where they explain a picture
constexpr double kWrongSize = 0.02;                   // prints are right to 0.5 %
constexpr double kOtherExposure = 0.2;                // relative to the exposure that was told
constexpr double kCurved = 0.1;                       // log of a response that is not the given one
constexpr double kAskew = 0.0125;     // [rad]: 0.7 deg; at 1.5 mm from the axis it moves an edge by 19 um
constexpr double kBent = 0.0015;      // of the radius: a ring of 4 mm on something round of 30 mm
constexpr double kOval = 0.006;       // of the radius: it moves the rotation by 0.4 deg to both sides
constexpr double kStandsOff = 0.025;  // of the size: 0.05 mm at the rim of a ring, 0.12 mm at the ends of a sleeve
constexpr double kReliefSignificant = 5, kLeastSlope = 0.01;
// Standard deviations before any picture: time between rows [s], tilt of a print and of a rod [rad].
constexpr double kUsualRowTime = 2e-5, kUsualAskew = 0.03, kUsualTilt = 0.2;
constexpr double kShearFloor = 2e-3;  // that other faults of the model leave in every picture of a sleeve [rad]
constexpr double kImpossible = 1e40;  // information of an unknown that is 0

}  // namespace

void FadingMean::add(const Distortion& distortion, double unit) {
  if (!(distortion.variance > 0)) return;
  const double information = square(unit) / distortion.variance;
  weight = kMemory * weight + information;
  sum = kMemory * sum + distortion.value / unit * information;
}

bool FadingMean::exceeds(double least, double deviations) const {
  return std::abs(sum) > least * weight && std::abs(sum) > deviations * std::sqrt(weight);
}

void CalibrationDoubts::reset() {
  information_.setZero();
  sums_.setZero();
  others_ = {};
  exposure_ = bend_ = relief_ = {};
  oval_ = {};
  relief_bias_ = log_scale_ = log_gamma_ = 0;
  fits_ = 0;
  solve();
}

CalibrationDoubts::Explanation CalibrationDoubts::explain(bool shutter, bool askew) const {
  Matrix h = information_;
  Vector sums = sums_;
  h(0, 0) += others_.information;
  sums[0] += others_.sum;
  const double print = askew ? 1 / square(kUsualAskew) : kImpossible;
  h.diagonal() += Vector(shutter ? 1 / square(kUsualRowTime) : kImpossible, print, print, 1 / square(kUsualTilt));
  Explanation found;
  found.covariance = h.llt().solve(Matrix::Identity());
  found.mean = found.covariance * sums;
  found.chi_squared = sums.dot(found.mean);
  return found;
}

/// A fault is believed if the pictures cannot be explained without it, or if some fault is needed and this one alone
/// explains them better than the other: while a rod turns as it slides, both look alike.
void CalibrationDoubts::solve() {
  const double kEnough = square(kSignificant);
  const Explanation none = explain(false, false), both = explain(true, true);
  const Explanation shutter = explain(true, false), askew = explain(false, true);
  const double by_shutter = shutter.chi_squared - none.chi_squared, by_askew = askew.chi_squared - none.chi_squared;
  row_deviation_ = std::sqrt(both.covariance(0, 0));
  row_time_ = 0;
  if (both.chi_squared - askew.chi_squared > kEnough)
    row_time_ = both.mean[0];
  else if (by_shutter > kEnough && by_shutter >= by_askew)
    row_time_ = shutter.mean[0];
  if (std::abs(row_time_) < kLeastRowTime) row_time_ = 0;
  double tilt = 0;
  if (both.chi_squared - shutter.chi_squared > kEnough)
    tilt = both.mean.segment<2>(1).norm();
  else if (by_askew > kEnough && by_askew > by_shutter)
    tilt = askew.mean.segment<2>(1).norm();
  askew_ = tilt > kAskew;
}

CalibrationDoubts::RowTime CalibrationDoubts::rowTimeSeen() const {
  Eigen::Matrix3d rest = information_.bottomRightCorner<3, 3>();
  rest.diagonal() += Eigen::Vector3d(1 / square(kUsualAskew), 1 / square(kUsualAskew), 1 / square(kUsualTilt));
  const Eigen::Vector3d common = information_.block<3, 1>(1, 0), share = rest.llt().solve(common);
  return {information_(0, 0) - share.dot(common), sums_[0] - share.dot(sums_.tail<3>())};
}

void CalibrationDoubts::addRowTime(const RowTime& others) {
  if (others.information == others_.information && others.sum == others_.sum) return;
  others_ = others;
  solve();
}

void CalibrationDoubts::add(const Vector& by, double value, double variance) {
  if (!(variance > 0)) return;
  const double weight = 1 / variance;
  information_ = kMemory * information_ + by * by.transpose() * weight;
  sums_ = kMemory * sums_ + by * value * weight;
  solve();
}

void CalibrationDoubts::addShear(const Distortion& shear, double speed) {
  add(Vector(speed, 0, 0, 0), shear.value, shear.variance);
}

/// A print that is askew on its rod seems to be tilted to one side and, half a turn later, to the other; a rod that is
/// askew always to the same.
void CalibrationDoubts::addShear(const Distortion& shear, double speed, double tilt, double rotation) {
  const double variance = shear.variance > 0 ? shear.variance + square(kShearFloor) : 0;
  add(Vector(speed, rows_ * std::cos(rotation), rows_ * std::sin(rotation), rows_), shear.value - rows_ * tilt,
      variance);
}

void CalibrationDoubts::addRelief(const Distortion& relief, double size, double slope, double uneven) {
  if (!(relief.variance > 0)) return;
  relief_.add(relief, size);
  const double sight = std::copysign(std::max(std::abs(slope), kLeastSlope), slope);
  relief_bias_ = kMemory * relief_bias_ + uneven / size / sight * (square(size) / relief.variance);
}

/// What moves the ends of a marker the same way wherever it is seen is no relief.
bool CalibrationDoubts::isBent() const {
  if (bend_.exceeds(kBent, kSignificant)) return true;
  const double deviation = std::sqrt(relief_.weight + square(relief_bias_));
  return std::abs(relief_.sum) > std::max(kStandsOff * relief_.weight, kReliefSignificant * deviation);
}

void CalibrationDoubts::addOval(const std::array<Distortion, 2>& oval) {
  for (std::size_t k = 0; k < 2; ++k) oval_[k].add(oval[k]);
}

bool CalibrationDoubts::isOval() const {
  double square_sum = 0, chi_squared = 0;
  for (const FadingMean& part : oval_) {
    square_sum += square(part.mean());
    chi_squared += part.mean() * part.sum;
  }
  return square_sum > square(kOval) && chi_squared > square(kSignificant);
}

void CalibrationDoubts::addFit(double log_scale, double log_gamma) {
  log_scale_ = fits_ == 0 ? log_scale : log_scale_ + kFitMemory * (log_scale - log_scale_);
  log_gamma_ = fits_ == 0 ? log_gamma : log_gamma_ + kFitMemory * (log_gamma - log_gamma_);
  ++fits_;
}

Doubt CalibrationDoubts::doubt() const {
  if (row_time_ != 0) return Doubt::Shutter;
  if (fits_ >= kEnoughFits && std::abs(log_scale_) > kWrongSize) return Doubt::Size;
  if (exposure_.exceeds(kOtherExposure, kSignificant)) return Doubt::Exposure;
  if (askew_) return Doubt::Askew;
  if (isBent()) return Doubt::Bent;
  if (isOval()) return Doubt::Oval;
  return fits_ >= kEnoughResponses && std::abs(log_gamma_) > kCurved ? Doubt::Response : Doubt::None;
}

/// Nobody tells which row the stamp is of: each is as likely.
double CalibrationDoubts::shutterError(double speed, int height) const {
  return std::abs(speed * row_time_) * height / std::sqrt(3.0);
}

double CalibrationDoubts::unknownShutterError(double speed, int height) const {
  return std::abs(speed) * row_deviation_ * height / std::sqrt(3.0);
}

}  // namespace vibe::vision
