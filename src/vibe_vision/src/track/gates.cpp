#include "track/gates.hpp"

#include <algorithm>
#include <cmath>

namespace vibe::vision {

Gates::Gates(const VisionConfig& config, const InstrumentConfig& instrument, const TrackerPolicy& policy)
    : limits_(config.gates),
      policy_(policy),
      begin_(alongOf(instrument.axis, instrument.lower)),
      end_(alongOf(instrument.axis, instrument.upper)),
      lateral_tolerance_(instrument.lateral_tolerance * instrument.axis.pixels_per_metre) {}

LostReason Gates::judge(const MarkerFit& fit, const FitVector& nominal, bool expected) const {
  const FitVector& x = fit.x;
  if (!fit.valid) return LostReason::NotFound;
  if (x[kContrast] < limits_.min_contrast || x[kBlack] > policy_.max_black * (x[kBlack] + x[kContrast]))
    return LostReason::NotFound;
  if (x[kAlong] < begin_ - policy_.slack || x[kAlong] > end_ + policy_.slack) return LostReason::NotFound;
  if (std::abs(x[kLateral]) > lateral_tolerance_ + policy_.slack) return LostReason::NotFound;
  const double scale = std::exp(x[kLogScale] - nominal[kLogScale]);
  const double length = scale * std::exp(x[kLogAspect] - nominal[kLogAspect]);
  const double wrong_size = std::max(std::abs(scale - 1), std::abs(length - 1));
  if (wrong_size > limits_.max_scale_error || sureTilt(fit) > limits_.max_tilt) return LostReason::Mismatch;
  if (fit.visible < limits_.min_visible) return LostReason::Occluded;
  const bool other = fit.weaker_edges < policy_.weaker_edges * fit.visible;
  const double part = expected ? 1 : std::clamp((fit.visible - 0.5) / 0.35, 0.0, 1.0);
  const double most = policy_.max_misfit_of_half + part * (policy_.max_misfit - policy_.max_misfit_of_half);
  return other || fit.misfit > most ? LostReason::Mismatch : LostReason::None;
}

bool Gates::showsStripe(const MarkerFit& fit) const {
  return fit.stripe_seen > policy_.stripe_seen * std::min(fit.visible, 1.0);
}

/// A ring shows its tilt only by the direction of its slant, which perspective turns a little.
double Gates::sureTilt(const MarkerFit& fit) const {
  double doubt = policy_.sure_tilt * std::sqrt(fit.covariance(kTilt, kTilt));
  if (fit.covariance(kLogAspect, kLogAspect) > 0)
    doubt += policy_.shear / std::max(std::abs(fit.x[kLogAspect]), policy_.shear);
  return std::abs(fit.x[kTilt]) - doubt;
}

}  // namespace vibe::vision
