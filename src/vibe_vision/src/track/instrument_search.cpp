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
  if (deviation > policy_.nearby_place) return false;
  const FitPrior prior = slow_.prior(slide);
  const double motion = std::abs(motionAt(prediction.slide, prediction.rotation, frame.exposure).length);
  MarkerFit fit = fitter_.acquire(map_, frame,
                                  {startAt(slide, prior, prediction), prior, motion, fastestMotion(frame),
                                   prediction.turn, policy_.nearby_reach * deviation});
  checkStripe(prior, prediction, fit);
  if (gates_.judge(fit, slow_.nominal(slide)) != LostReason::None || fit.visible < policy_.nearby_visible) return false;
  if (!isNear(fit, prediction) && !isExpectedPart(fit, prediction)) return false;
  accept(frame, fit, prediction, true);
  lookForDistortions(frame, fit);
  stateDoubts(frame);
  return true;
}

bool InstrumentTracker::searchRange(const Frame& frame, const Prediction& prediction, double begin, double end) {
  const double from = alongOf(config_.axis, std::max(begin, config_.lower)) - policy_.search_margin;
  const double to = alongOf(config_.axis, std::min(end, config_.upper)) + policy_.search_margin;
  const AxisSearch::Result& found = search_.run(map_, frame, from, to, fastestMotion(frame).length, min_contrast_);
  reason_ = whyNothing({found.in_view, found.saturated, found.brightest}, min_contrast_, policy_);
  bool is_last = false;
  const MarkerFit best = bestOf(frame, prediction, found, is_last);
  if (!best.valid) return false;
  if (!isExpected(best, prediction, frame.stamp)) {
    reason_ = LostReason::Jump;
    return false;
  }
  const double near = fitter_.shows(kRotation) ? policy_.nearby_place : policy_.known_place;
  copies_.find(best.x[kAlong], lost_frames_ > 0 && !isWithin(near, best, prediction));
  accept(frame, best, prediction, true);
  if (is_last && prediction.known) lookForDistortions(frame, best);
  rememberCopies(frame, found, from, to, best.x[kAlong]);
  stateDoubts(frame);
  return true;
}

/// @param is_last  the fitter has its pixels
MarkerFit InstrumentTracker::bestOf(const Frame& frame, const Prediction& prediction, const AxisSearch::Result& found,
                                    bool& is_last) {
  MarkerFit best;
  best.loss = 1e9;
  const bool patient = lost_frames_ > policy_.relax_after;
  for (int i = 0; i < found.count && tries_ < (patient ? policy_.tries - 1 : policy_.tries); ++i, ++tries_) {
    const int other = patient && i > 0 ? 1 + lost_frames_ % (found.count - 1) : i;
    if (copies_.isAt(found.candidates[other].along)) continue;
    is_last = consider(tryCandidate(frame, prediction, found.candidates[other]), prediction, best);
    if (best.valid && best.loss < policy_.good_loss) return best;
  }
  const bool likely = found.count > 0 && found.candidates[0].score > policy_.looks_alike;
  if (!best.valid && likely && fitter_.shows(kRotation) && !copies_.isAt(found.candidates[0].along))
    is_last = consider(tryBars(frame, prediction, found.candidates[0]), prediction, best);
  return best;
}

/// @return whether it is the marker, and better
bool InstrumentTracker::consider(const MarkerFit& fit, const Prediction& prediction, MarkerFit& best) {
  LostReason reason = gates_.judge(fit, slow_.nominal(slideOf(config_.axis, fit.x[kAlong])), false);
  if (reason == LostReason::None && fitter_.shows(kRotation) && isPart(fit) && !isNear(fit, prediction) &&
      !isExpectedPart(fit, prediction))
    reason = LostReason::Occluded;
  if (reason != LostReason::None && fit.clipped > policy_.clipped_share) reason = LostReason::Saturated;
  const bool better = reason == LostReason::None && fit.loss < best.loss;
  if (better) best = fit;
  if (reason != LostReason::None && reason_ == LostReason::NotFound) reason_ = reason;
  return better;
}

/// What looks like the marker and rests, but is not what is followed.
void InstrumentTracker::rememberCopies(const Frame& frame, const AxisSearch::Result& found, double from, double to,
                                       double own) {
  const double apart = fitter_.pattern().maxWindow().x();
  copies_.forget(from, to, own, apart);
  for (int i = 0; i < found.count; ++i) {
    const AxisSearch::Candidate& other = found.candidates[i];
    const bool alike = other.score > policy_.looks_alike && other.motion < policy_.telling_motion;
    if (!alike || std::abs(other.along - own) < apart) continue;
    MarkerFit best;
    best.loss = policy_.good_loss;
    if (consider(tryCandidate(frame, {}, other), {}, best)) copies_.see(other.along);
  }
}

/// A little of the axis in some frames.
void InstrumentTracker::lookForCopies(const Frame& frame) {
  if (++looks_for_copies_ % policy_.look_every != 0) return;
  const double from = search_.begin() + looked_, to = std::min(from + policy_.copy_step, search_.end());
  looked_ = to < search_.end() ? looked_ + policy_.copy_step : 0;
  rememberCopies(frame, search_.run(map_, frame, from, to, 0, min_contrast_), from, to, measurement_.along);
}

/// As long as what is followed may be a copy, something else may be the marker.
bool InstrumentTracker::leaveCopy(const Frame& frame) {
  if (!measurement_.tracked() || !copies_.doubted() || ++doubted_frames_ % policy_.copy_search != 0) return false;
  const double own = measurement_.along;
  copies_.see(own);
  if (searchRange(frame, {}, config_.lower, config_.upper)) return true;
  copies_.forget(own, own, own, -1);
  return false;
}

MarkerFit InstrumentTracker::tryCandidate(const Frame& frame, const Prediction& prediction,
                                          const AxisSearch::Candidate& candidate) {
  const double slide = slideOf(config_.axis, candidate.along);
  const FitPrior prior = searchPrior(slide);
  FitVector start = startAt(slide, prior, prediction);
  const double size = std::log(candidate.scale);
  if (std::abs(size - start[kLogScale]) > policy_.scale_step) start[kLogScale] = size;
  if (candidate.shows_rotation && !prediction.turn) start[kRotation] = candidate.rotation;
  const MarkerMotion most = fastestMotion(frame);
  MarkerFit fit =
      fitter_.acquire(map_, frame, {start, prior, candidate.motion, most, prediction.turn || candidate.shows_rotation});
  // What covers a part of a sleeve looks like motion: the mean along the axis then tells neither that nor the rotation.
  if (fitter_.shows(kRotation) && prediction.known && fit.loss > policy_.good_loss) {
    const double motion = std::abs(motionAt(prediction.slide, prediction.rotation, frame.exposure).length);
    start = startAt(slide, prior, prediction);
    const MarkerFit other =
        fitter_.acquire(map_, frame, {start, prior, std::min(motion, most.length), most, prediction.turn});
    if (other.valid && (!fit.valid || other.loss < fit.loss)) fit = other;
  }
  checkStripe(prior, prediction, fit);
  return fit;
}

/// A candidate the stripe of which is hidden, so that it would keep the fit from the bars.
MarkerFit InstrumentTracker::tryBars(const Frame& frame, const Prediction& prediction,
                                     const AxisSearch::Candidate& candidate) {
  const double slide = slideOf(config_.axis, candidate.along);
  const FitPrior prior = withTurn(searchPrior(slide), prediction);
  fitter_.useStripe(false);
  MarkerFit fit = fitter_.acquire(
      map_, frame, {startAt(slide, prior, prediction), prior, candidate.motion, fastestMotion(frame), true});
  if (fit.valid) fitter_.leaveStripe(fit, prior);
  fitter_.useStripe(true);
  fit.shows_turn = false;
  return fit;
}

/// Part of the bars also fits at other places, but not as well.
bool InstrumentTracker::isPart(const MarkerFit& fit) const {
  const double whole = std::clamp((fit.visible - policy_.whole_from) / (policy_.whole - policy_.whole_from), 0.0, 1.0);
  return fit.visible < policy_.search_visible ||
         fit.misfit > policy_.part_misfit + whole * (policy_.whole_misfit - policy_.part_misfit);
}

/// Where else the bars would fit is further away.
bool InstrumentTracker::isNear(const MarkerFit& fit, const Prediction& prediction) const {
  return isWithin(policy_.known_place, fit, prediction);
}

/// A part whose stripe fits, too, within a length of the sleeve or so.
bool InstrumentTracker::isExpectedPart(const MarkerFit& fit, const Prediction& prediction) const {
  return fit.visible > policy_.nearby_visible && fit.stripe_seen > policy_.expected_stripe &&
         isWithin(policy_.expected_place, fit, prediction);
}

/// Of the prediction, if that is known so well. @param place  its deviation, at most [px]
bool InstrumentTracker::isWithin(double place, const MarkerFit& fit, const Prediction& prediction) const {
  if (!prediction.known) return false;
  const double deviation = prediction.slide.deviation() * pixelsPerMetre(config_.axis, prediction.slide.mean[0]);
  const double distance = std::abs(fit.x[kAlong] - alongOf(config_.axis, prediction.slide.mean[0]));
  return deviation < place && distance < policy_.near * deviation;
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
