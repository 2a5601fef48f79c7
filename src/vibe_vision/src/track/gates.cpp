#include "track/gates.hpp"

#include <algorithm>
#include <cmath>

namespace vibe::vision {

namespace {

// chi^2 per degree of freedom of the pixels that are no outliers: of a marker that is seen as a whole, of half of one.
// What is left of a covered marker fits other poses nearly as well, unless the place is known.
constexpr double kMaxMisfit = 4, kMaxMisfitOfHalf = 1.5;
constexpr double kDeviations = 6;     // of the prediction
constexpr double kSureTilt = 3;       // standard deviations
constexpr double kShear = 0.004;      // of a slanted ring away from the middle of the image
constexpr double kRest = 1e-4;        // by which anything may have moved [m]
constexpr double kWeakerEdges = 0.4;  // of the share of all edges
constexpr double kSlack = 1;          // beyond the range and across the axis [px]
constexpr double kMaxBlack = 0.75;    // of white: paper and ink differ more

/// A ring shows its tilt only by the direction of its slant, which perspective turns a little.
double sureTilt(const MarkerFit& fit) {
  double doubt = kSureTilt * std::sqrt(fit.covariance(kTilt, kTilt));
  if (fit.covariance(kLogAspect, kLogAspect) > 0) doubt += kShear / std::max(std::abs(fit.x[kLogAspect]), kShear);
  return std::abs(fit.x[kTilt]) - doubt;
}

}  // namespace

Gates::Gates(const VisionConfig& config, const InstrumentConfig& instrument)
    : limits_(config.gates),
      motion_(instrument.motion),
      begin_(alongOf(instrument.axis, instrument.lower)),
      end_(alongOf(instrument.axis, instrument.upper)),
      lateral_tolerance_(instrument.lateral_tolerance * instrument.axis.pixels_per_metre) {}

LostReason Gates::judge(const MarkerFit& fit, const FitVector& nominal, bool expected) const {
  const FitVector& x = fit.x;
  if (!fit.valid) return LostReason::NotFound;
  if (x[kContrast] < limits_.min_contrast || x[kBlack] > kMaxBlack * (x[kBlack] + x[kContrast]))
    return LostReason::NotFound;
  if (x[kAlong] < begin_ - kSlack || x[kAlong] > end_ + kSlack) return LostReason::NotFound;
  if (std::abs(x[kLateral]) > lateral_tolerance_ + kSlack) return LostReason::NotFound;
  const double scale = std::exp(x[kLogScale] - nominal[kLogScale]);
  const double length = scale * std::exp(x[kLogAspect] - nominal[kLogAspect]);
  const double wrong_size = std::max(std::abs(scale - 1), std::abs(length - 1));
  if (wrong_size > limits_.max_scale_error || sureTilt(fit) > limits_.max_tilt) return LostReason::Mismatch;
  if (fit.visible < limits_.min_visible) return LostReason::Occluded;
  const bool other = fit.weaker_edges < kWeakerEdges * fit.visible;
  const double part = expected ? 1 : std::clamp((fit.visible - 0.5) / 0.35, 0.0, 1.0);
  const double most = kMaxMisfitOfHalf + part * (kMaxMisfit - kMaxMisfitOfHalf);
  return other || fit.misfit > most ? LostReason::Mismatch : LostReason::None;
}

/// A stop ends a motion at once: from where it was, only the speed is limited.
bool Gates::isReachable(double slide, const MotionFilter::State& predicted, double last_slide, double dt) const {
  const double travel = motion_.max_speed * dt + kRest;
  return std::abs(slide - last_slide) <= travel ||
         std::abs(slide - predicted.mean[0]) <= kDeviations * predicted.deviation();
}

}  // namespace vibe::vision
