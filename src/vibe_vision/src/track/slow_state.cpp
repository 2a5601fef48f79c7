#include "track/slow_state.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace vibe::vision {
namespace {

// Standard deviations at the beginning, and random walk from one frame to the next. Design choices.
constexpr double kScalePrior = 0.08, kScaleDrift = 5e-5;
constexpr double kTiltPrior = 0.15, kTiltDrift = 5e-4;  // [rad]
constexpr double kAspectPrior = 0.04, kAspectDrift = 3e-5;
constexpr double kBlurPrior = 0.5, kBlurDrift = 2e-3;  // [px]
// Of a rod, slant and slide, and lateral and rotation, look nearly the same in one picture; guides hold the rod, so
// that all pictures together tell them apart.
constexpr double kSlantPrior = 0.2, kSlantDrift = 2e-5;  // [rad]
constexpr double kLateralDrift = 3e-3;                   // [px]
constexpr double kLeastSlant = 0.01;                     // [rad]: nobody glues a marker better
constexpr double kLeastAspect = 0.01;                    // from which the direction of the slant can be told
constexpr double kGammaPrior = 0.5;                      // of a camera whose response is not given: 1 to 2.4 are common
constexpr double kSlopePrior = 2e-3, kSlopeDrift = 4e-6;  // of the light [1/px], and per pixel of travel

}  // namespace

SlowState::SlowState(const VisionConfig& config, const InstrumentConfig& instrument,
                     const std::array<bool, kPoseParameters>& shown)
    : axis_(instrument.axis), blur_(config.blur), gamma_(config.gamma.value_or(1)) {
  focal_ = (config.camera.fx + config.camera.fy) / 2;
  slant_ = std::atan(axis_.perspective * focal_ / axis_.pixels_per_metre);
  lateral_tolerance_ = instrument.lateral_tolerance * axis_.pixels_per_metre;
  initial_deviation_.setZero();
  drift_.setZero();
  const auto add = [&](int k, double deviation, double drift) {
    if (k < kPoseParameters && !shown[k]) return;
    index_[count_++] = k;
    initial_deviation_[k] = deviation;
    drift_[k] = drift;
  };
  if (shown[kRotation]) add(kLateral, lateral_tolerance_, kLateralDrift);
  add(kLogScale, kScalePrior, kScaleDrift);
  add(kTilt, kTiltPrior, kTiltDrift);
  add(kLogAspect, kAspectPrior, kAspectDrift);
  add(kBlur, kBlurPrior, kBlurDrift);
  add(kKeystone, kSlantPrior / focal_, kSlantDrift / focal_);
  add(kSlant, kSlantPrior, kSlantDrift);
  add(kSlopeAlong, kSlopePrior, kSlopeDrift);
  add(kSlopeLateral, kSlopePrior, kSlopeDrift);
  if (!config.gamma) add(kGamma, kGammaPrior, 0);
  reset();
}

void SlowState::reset() {
  mean_.setZero();
  covariance_.setZero();
  covariance_.diagonal() = initial_deviation_.cwiseAbs2();
}

/// How much the marker may be slanted against the sensor, from its shape: one that is as long as wide is not.
double SlowState::greatestSlant() const {
  const double deviation = std::sqrt(covariance_(kLogAspect, kLogAspect));
  const double aspect = mean_[kLogAspect] + std::log(std::cos(slant_)) - 2 * deviation;
  return std::max(std::acos(std::exp(std::min(aspect, 0.0))) + std::abs(slant_), kLeastSlant);
}

/// Random walk, but never less certain than at the beginning. The camera sees a slanted marker from another side after
/// it has moved, which changes its shape.
void SlowState::predict(double travel) {
  const double turn = std::abs(travel) / focal_ * std::sin(greatestSlant());
  for (int i = 0; i < count_; ++i) {
    const int k = index_[i];
    double step = drift_[k];
    if (k == kSlopeAlong || k == kSlopeLateral) step *= 1 + std::abs(travel);
    if (k == kLogAspect || k == kLogScale) step += turn;
    if (k == kTilt && initial_deviation_[kLogAspect] > 0)
      step += turn / (2 * std::max(std::abs(mean_[kLogAspect]), kLeastAspect));
    const double room = initial_deviation_[k] * initial_deviation_[k] - covariance_(k, k);
    covariance_(k, k) += std::max(0.0, std::min(step * step, room));
  }
  limitKeystone();
}

/// Only a slanted marker grows along its picture: taken as a measurement of 0 that leaves the variance of the limit.
void SlowState::limitKeystone() {
  const double variance = covariance_(kKeystone, kKeystone), limit = greatestSlant() / focal_;
  if (variance <= limit * limit) return;
  const FitVector common = covariance_.col(kKeystone);
  const double gain = (1 - limit * limit / variance) / variance;
  mean_ -= common * gain * mean_[kKeystone];
  covariance_ -= gain * common * common.transpose();
}

/// What the fit did not look for, the response once it is known, stays as it was.
void SlowState::update(const FitVector& x, const FitMatrix& covariance, double slide, double doubt) {
  const FitVector base = nominal(slide);
  for (int i = 0; i < count_; ++i) {
    mean_[index_[i]] = x[index_[i]] - base[index_[i]];
    const double before = covariance_(index_[i], index_[i]);
    for (int j = 0; j < count_; ++j) covariance_(index_[i], index_[j]) = covariance(index_[i], index_[j]);
    if (covariance(index_[i], index_[i]) == 0) covariance_(index_[i], index_[i]) = before;
  }
  for (int i = 0; i < count_; ++i)
    covariance_(index_[i], index_[i]) += doubt * initial_deviation_[index_[i]] * initial_deviation_[index_[i]];
}

FitPrior SlowState::prior(double slide) const {
  FitPrior prior;
  prior.mean = nominal(slide) + mean_;
  FitSubmatrix covariance(count_, count_);
  for (int i = 0; i < count_; ++i)
    for (int j = 0; j < count_; ++j) covariance(i, j) = covariance_(index_[i], index_[j]);
  const FitSubmatrix inverse = covariance.llt().solve(FitSubmatrix::Identity(count_, count_));
  for (int i = 0; i < count_; ++i)
    for (int j = 0; j < count_; ++j) prior.information(index_[i], index_[j]) = inverse(i, j);
  if (initial_deviation_[kLateral] == 0)
    prior.information(kLateral, kLateral) = 1 / (lateral_tolerance_ * lateral_tolerance_);
  return prior;
}

/// A straight axis that leaves the image plane by the angle `slant_` makes the marker smaller with the distance, and
/// shorter along than across.
FitVector SlowState::nominal(double slide) const {
  const double w = 1 + axis_.perspective * slide;
  FitVector x = FitVector::Zero();
  x[kLogScale] = -std::log(w) - std::log(std::cos(slant_));
  x[kLogAspect] = -std::log(w) + std::log(std::cos(slant_));
  x[kBlur] = blur_;
  x[kGamma] = gamma_;
  x[kKeystone] = -axis_.perspective * w / axis_.pixels_per_metre;
  x[kSlant] = slant_;
  return x;
}

}  // namespace vibe::vision
