#include <algorithm>
#include <cmath>

#include "track/arithmetic.hpp"
#include "track/instrument_tracker.hpp"

namespace vibe::vision {

bool InstrumentTracker::search(const Frame& frame, const Prediction& prediction) {
  const LostReason before = reason_;
  if (searchNearby(frame, prediction)) return true;
  if (prediction.known) {
    const double reach = config_.motion.max_speed * prediction.dt;
    if (searchRange(frame, prediction, last_slide_ - reach, last_slide_ + reach)) return true;
    if (reach > config_.upper - config_.lower) return false;
  }
  if (searchRange(frame, prediction, config_.lower, config_.upper)) return true;
  if (reason_ == LostReason::NotFound && before != LostReason::None) reason_ = before;
  return false;
}

/// Around a prediction that is too vague to be followed. This finds a partly covered marker, too.
bool InstrumentTracker::searchNearby(const Frame& frame, const Prediction& prediction) {
  if (!prediction.known || prediction.close || !fitter_.shows(kRotation)) return false;
  const double slide = std::clamp(prediction.slide.mean[0], config_.lower, config_.upper);
  const double scale = pixelsPerMetre(config_.axis, slide), deviation = prediction.slide.deviation() * scale;
  if (deviation > policy_.known_place) return false;
  const FitPrior prior = slow_.prior(slide);
  const double motion = std::abs(motionAt(prediction.slide, prediction.rotation, frame.exposure).length);
  const bool known_rotation = prediction.rotation.deviation() < policy_.known_rotation;
  const MarkerFit fit = fitter_.acquire(map_, frame, startAt(slide, prior, prediction), prior, motion,
                                        fastestMotion(frame), known_rotation, policy_.nearby_reach * deviation);
  if (gates_.judge(fit, slow_.nominal(slide)) != LostReason::None || fit.visible < policy_.nearby_visible) return false;
  if (!isNear(fit, prediction)) return false;
  accept(frame, fit, prediction, true);
  stateDoubts(frame);
  return true;
}

bool InstrumentTracker::searchRange(const Frame& frame, const Prediction& prediction, double begin, double end) {
  const double from = alongOf(config_.axis, std::max(begin, config_.lower));
  const double to = alongOf(config_.axis, std::min(end, config_.upper));
  const double fastest = fastestMotion(frame).length;
  const AxisSearch::Result& found =
      search_.run(map_, frame, from - policy_.search_margin, to + policy_.search_margin, fastest, min_contrast_);
  MarkerFit best;
  best.loss = 1e9;
  bool is_last = false;  // whose pixels the fitter has
  reason_ = whyNothing({found.in_view, found.saturated, found.brightest}, min_contrast_, policy_);
  const bool patient = lost_frames_ > policy_.relax_after;
  for (int i = 0; i < found.count && tries_ < (patient ? policy_.tries - 1 : policy_.tries); ++i, ++tries_) {
    const int other = patient && i > 0 ? 1 + lost_frames_ % (found.count - 1) : i;
    const MarkerFit fit = tryCandidate(frame, prediction, found.candidates[other]);
    LostReason reason = gates_.judge(fit, slow_.nominal(slideOf(config_.axis, fit.x[kAlong])), false);
    if (reason == LostReason::None && fitter_.shows(kRotation) && isPart(fit) && !isNear(fit, prediction))
      reason = LostReason::Occluded;
    if (reason != LostReason::None && fit.clipped > policy_.clipped_share) reason = LostReason::Saturated;
    const bool better = reason == LostReason::None && fit.loss < best.loss;
    if (better) best = fit;
    is_last = better;
    if (reason != LostReason::None && reason_ == LostReason::NotFound) reason_ = reason;
    if (best.valid && best.loss < policy_.good_loss) break;
  }
  if (!best.valid) return false;
  if (!isExpected(best, prediction, frame.stamp)) {
    reason_ = LostReason::Jump;
    return false;
  }
  accept(frame, best, prediction, true);
  if (is_last && prediction.known) lookForDistortions(frame, best);
  stateDoubts(frame);
  return true;
}

MarkerFit InstrumentTracker::tryCandidate(const Frame& frame, const Prediction& prediction,
                                          const AxisSearch::Candidate& candidate) {
  const double slide = slideOf(config_.axis, candidate.along);
  const MarkerMotion fastest = fastestMotion(frame);
  const bool known_rotation =
      prediction.known && rotation_.started() && prediction.rotation.deviation() < policy_.known_rotation;
  const FitPrior prior = searchPrior(slide);
  FitVector start = startAt(slide, prior, prediction);
  const double size = std::log(candidate.scale);
  if (std::abs(size - start[kLogScale]) > policy_.scale_step) start[kLogScale] = size;
  if (candidate.shows_rotation && !known_rotation) start[kRotation] = candidate.rotation;
  return fitter_.acquire(map_, frame, start, prior, candidate.motion, fastest,
                         known_rotation || candidate.shows_rotation);
}

/// Part of the bars also fits at other places, but not as well.
bool InstrumentTracker::isPart(const MarkerFit& fit) const {
  const double whole = std::clamp((fit.visible - policy_.whole_from) / (policy_.whole - policy_.whole_from), 0.0, 1.0);
  return fit.visible < policy_.search_visible ||
         fit.misfit > policy_.part_misfit + whole * (policy_.whole_misfit - policy_.part_misfit);
}

/// Where else the bars would fit is further away.
bool InstrumentTracker::isNear(const MarkerFit& fit, const Prediction& prediction) const {
  if (!prediction.known) return false;
  const double deviation = prediction.slide.deviation() * pixelsPerMetre(config_.axis, prediction.slide.mean[0]);
  const double distance = std::abs(fit.x[kAlong] - alongOf(config_.axis, prediction.slide.mean[0]));
  return deviation < policy_.known_place && distance < policy_.near * deviation;
}

bool InstrumentTracker::isExpected(const MarkerFit& fit, const Prediction& prediction, double stamp) {
  return !prediction.known ||
         reach_.believes(slideOf(config_.axis, fit.x[kAlong]), stamp, prediction.slide, last_slide_, prediction.dt);
}

/// What was learnt may be wrong if it finds nothing.
FitPrior InstrumentTracker::searchPrior(double slide) const {
  const bool doubted = lost_frames_ >= policy_.doubt_after && lost_frames_ % 2 == 1;
  return doubted ? unknown_.prior(slide) : slow_.prior(slide);
}

MarkerMotion InstrumentTracker::fastestMotion(const Frame& frame) const {
  const double scale = config_.axis.pixels_per_metre;
  return {config_.motion.max_speed * frame.exposure * scale,
          config_.motion.max_acceleration * square(frame.exposure) / 16 * scale,
          config_.motion.max_angular_speed * frame.exposure};
}

}  // namespace vibe::vision
