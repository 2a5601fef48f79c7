#include <algorithm>
#include <array>
#include <cmath>

#include "track/marker_fitter.hpp"

namespace vibe::vision {

namespace {

constexpr double kAligned = 0.2;            // a step after which the coarse alignment ends [px]
constexpr double kMotionTrials[] = {2, 1};  // [px]
constexpr double kTellingMotion = 6;        // from which what is seen where edges meet tells the motion [px]
constexpr int kMotionRefinements = 10;      // trials of a motion,
constexpr double kMotionRefined = 0.2;      // until a step is this short [px]
constexpr double kWorthRefining = 0.35;     // loss of a pixel up to which it may be the marker
constexpr double kMotionTrial = 0.1, kBendTrial = 0.1, kTurnTrial = 0.02;  // for derivatives [px], [rad]
constexpr double kMostMotionStep = 1.5, kMostBendStep = 0.4;               // at most [px]
constexpr double kGuessedLight = 0.05;                  // standard deviation of the light on a rod, after one frame
constexpr double kMotionUncertainty = 0.3;              // of the edges while it is tried [px]
constexpr double kCoarseBlur = 2.4, kMiddleBlur = 0.9;  // more than the camera's [px]
constexpr double kUnknownGamma = 0.1;                   // standard deviation from which a search tries another one,
constexpr double kCommonGamma = 2.2;                    // that of many cameras
constexpr double kStrange = 2.5;                        // misfit from which the response may be why,
constexpr double kStrangeRod = 1.4;                     // the same of a rod, whose light is looked for, too
constexpr double kBothEdges = 0.6;  // of the share of all edges: a curve moves white and black ones apart
// kLearnVisible before the line of the lamp on a rod is known well, and while its light is the one that a picture with
// dirt suggests.
constexpr double kLearnSheen = 0.6, kLearnGuessed = 0.7;
constexpr int kLitFrames = 4;   // followed ones, after which the light is known beside a long motion
constexpr int kGuessAfter = 3;  // tries after which what was learnt of the light is doubted
// Misfit from which, and loss of a pixel up to which, a search looks for the ink; candidates for which it does until a
// marker is followed, which bounds the time; steps.
constexpr double kStrangeInk = 1.3, kWorthInk = 0.5;
constexpr int kInkTries = 6, kInkSteps = 3;
constexpr double kHopeless = 0.8;      // loss of a pixel after the coarse alignment
constexpr double kVeryHopeless = 0.8;  // before size and tilt are known
constexpr double kPoor = 0.25;         // loss of a pixel from which the rotation may be wrong
constexpr int kAlignSteps = 3;
constexpr double kPlaceTrial = 1.5;  // [px]
constexpr int kAcquireSteps = 14;    // a covered marker needs many

}  // namespace

MarkerFit MarkerFitter::acquire(AxisMap& map, const Frame& frame, const Candidate& candidate) {
  most_ = candidate.most;
  MarkerFit fit = acquireWithAnyResponse(map, frame, candidate);
  if (fit.misfit > kStrangeInk && fit.loss < kWorthInk && !ink_known_ && ink_tries_ < kInkTries)
    fit = acquireWithInk(map, frame, candidate, fit);
  // Only now: another motion would also explain some of what a response does.
  const bool strange = light_.isRound() && fit.valid && fit.misfit > kStrangeMotion && !isMotionLong(fit);
  if (strange && most_.length > 1 && fit.loss < kWorthRefining && read(map, frame, fit))
    refineMotion(fit, candidate.prior, most_.length);
  return fit;
}

MarkerFit MarkerFitter::acquireWithAnyResponse(AxisMap& map, const Frame& frame, const Candidate& candidate) {
  const MarkerFit fit = tryToAcquire(map, frame, candidate);
  const double known = candidate.prior.information(kGamma, kGamma);
  const auto explains = [this](const MarkerFit& f) {
    const double strange = light_.isRound() ? kStrangeRod : kStrange;
    return f.valid && f.loss < kPoor && f.misfit < strange && f.weaker_edges > kBothEdges * f.visible;
  };
  if (explains(fit) || seen_ > 0 || known == 0 || known * kUnknownGamma * kUnknownGamma > 1) return fit;
  Candidate other = candidate;
  other.start[kGamma] = kCommonGamma;
  const MarkerFit second = tryToAcquire(map, frame, other);
  return explains(second) && (!fit.valid || second.loss < fit.loss) ? second : fit;
}

/// Lines that are wider or narrower than designed spoil the fit of a marker that nothing else explains.
/// @param first  that fit
MarkerFit MarkerFitter::acquireWithInk(AxisMap& map, const Frame& frame, const Candidate& candidate,
                                       const MarkerFit& first) {
  ++ink_tries_;
  const double before = ink_;
  Candidate again = candidate;
  again.start[kGamma] = first.x[kGamma];
  again.reach = 0;
  MarkerFit fit = first;
  for (int i = 0; i < kInkSteps && fit.loss < kWorthInk; ++i) {
    // Another response may have been tried last.
    if (!read(map, frame, fit, true)) break;
    refine(fit, candidate.prior, kMotionUncertainty, kAcquireSteps);
    if (!learnInk(fit, candidate.prior)) break;
    again.motion = fit.motion.length;
    fit = tryToAcquire(map, frame, again);
  }
  // What covers a marker would be explained by lines of another width, too, but not all of it.
  if (fit.valid && fit.visible > kLearnVisible && fit.misfit < kStrangeMotion) return fit;
  if (ink_ != before) setInk(before);
  return first;
}

MarkerFit MarkerFitter::tryToAcquire(AxisMap& map, const Frame& frame, const Candidate& candidate) {
  const FitPrior& prior = candidate.prior;
  MarkerFit fit;
  fit.x = candidate.start;
  fit.motion = candidate.motion;
  const double blur = fit.x[kBlur];
  // The search knows the place of a sleeve well, and its bars would vanish.
  fit.x[kBlur] = blur + (observed_[kRotation] ? kMiddleBlur : kCoarseBlur);
  const bool guess = !light_.known() || ++tries_ > kGuessAfter;
  if (!read(map, frame, fit, guess)) return fit;
  usePixels(observed_[kRotation] ? 2 : 4);
  if (candidate.reach > 0) choosePlace(fit, candidate.reach);
  if (!align(fit, prior, FitScope::Position)) return fit;
  if (!observed_[kRotation] && fit.loss > kVeryHopeless) return fit;  // else the rotation may be wrong
  fit.x[kBlur] = blur + kMiddleBlur;
  if (observed_[kRotation] && (!candidate.known_rotation || fit.loss > kPoor)) choose(kRotation, rotations_, fit);
  if (!read(map, frame, fit)) return fit;
  usePixels(observed_[kRotation] ? 2 : 4);
  if (!align(fit, prior, FitScope::Shape) || fit.loss > kHopeless) return fit;
  // The blur is not that of the prior if the camera is out of focus: edges along the motion tell it, and thin bars.
  if (!align(fit, prior, FitScope::All)) return fit;
  if (most_.length > 1) chooseMotion(fit, prior);
  if (!read(map, frame, fit)) return fit;
  refine(fit, prior, kMotionUncertainty, kAcquireSteps);
  if (isMotionLong(fit)) refineMotion(fit, prior, most_.length);
  if (!light_.isRound()) return fit;
  // The fit began aside: some of its pixels are on the rim or behind the ends, and others are missing.
  if (fit.loss < kPoor) {
    if (!read(map, frame, fit)) return fit;
    refine(fit, prior, kMotionUncertainty, kAcquireSteps);
  }
  const bool unsure = guess || (lit_frames_ < kLitFrames && isMotionLong(fit));
  const int rounds = !unsure ? 0 : (light_.shines() ? 2 : 1);
  for (int i = 0; i < rounds && fit.visible > (light_.shines() ? kLearnSheen : kLearnGuessed); ++i) {
    refineWithLight(fit, prior);
    if (fit.valid && guess) tries_ = 0;
  }
  if (fit.valid && fit.visible > kLearnSheen) doubtLight(fit);
  return fit;
}

/// Together with the light, since one picture hardly tells it from the rotation and the place across the axis, and with
/// the motion.
void MarkerFitter::refineWithLight(MarkerFit& fit, const FitPrior& prior) {
  fit_.learnLight(fit.x, pixels_, light_);
  light_.shine(poseOf(fit.x), pixels_, pixels_.padded());
  sides_ = sideLimits(fit);
  refine(fit, prior, kMotionUncertainty, kAcquireSteps);
  sides_ = {};
}

/// A short motion looks like blur, which is a parameter.
SideLimits MarkerFitter::sideLimits(const MarkerFit& fit) const {
  if (!isMotionLong(fit) || most_.bend <= 0 || most_.turn <= 0) return {kGuessedLight, {}};
  return {kGuessedLight, {most_.length / 2, most_.bend / 2, most_.turn / 2}};
}

/// A Gauss-Newton step as the last one, with the light on a rod and the motion as further unknowns.
void MarkerFitter::stepWithSides(MarkerFit& fit, FitStep& step) {
  measureMotion(fit, sides_);
  const MarkerMotion change = fit_.stepWithLight(pixels_, light_, sides_, fit.motion, step);
  fit.motion.length = std::max(fit.motion.length + std::clamp(change.length, -kMostMotionStep, kMostMotionStep), 0.0);
  fit.motion.bend += std::clamp(change.bend, -kMostBendStep, kMostBendStep);
  fit.motion.turn = std::clamp(fit.motion.turn + change.turn, -most_.turn, most_.turn);
}

void MarkerFitter::measureMotion(const MarkerFit& fit, const SideLimits& limits) {
  if (limits.motion.length == 0) return;
  const auto measure = [this, &fit](int k, double MarkerMotion::*part, double by) {
    MarkerFit other = fit;
    other.motion.*part += by;
    prepare(other);
    fit_.measureMotion(k, pixels_, by);
  };
  measure(0, &MarkerMotion::length, kMotionTrial);
  measure(1, &MarkerMotion::bend, kBendTrial);
  measure(2, &MarkerMotion::turn, kTurnTrial);
}

/// A few steps with a picture that is more blurred than the camera's: its edges reach further.
bool MarkerFitter::align(MarkerFit& fit, const FitPrior& prior, FitScope scope) {
  prepare(fit, true);
  for (int i = 0; i < kAlignSteps; ++i) {
    fit_.evaluate(fit.x, pixels_);
    if (i == 0) fit_.startLevels(pixels_, fit.x);
    const FitStep step = fit_.step(fit.x, prior, pixels_, {fit.x[kBlur], scope});
    if (!step.valid) return false;
    fit.loss = step.loss;
    take(step, fit);
    if (lengthOf(step) < kAligned) break;
  }
  return true;
}

/// The place with the least loss of a pixel, from trials.
void MarkerFitter::choosePlace(MarkerFit& fit, double reach) {
  std::vector<double> places;
  const int steps = static_cast<int>(std::ceil(reach / kPlaceTrial));
  for (int k = -steps; k <= steps; ++k) places.push_back(fit.x[kAlong] + k * kPlaceTrial);
  fit.loss = 2;
  choose(kAlong, places, fit);
}

/// The value of a parameter with the least loss of a pixel; that of the fit stays if no other is better.
void MarkerFitter::choose(PoseIndex k, const std::vector<double>& values, MarkerFit& fit) {
  FitVector best = fit.x;
  double least = fit.loss;
  prepare(fit, true);
  for (const double value : values) {
    fit.x[k] = value;
    fit_.evaluate(fit.x, pixels_);
    fit_.startLevels(pixels_, fit.x);
    const double loss = fit_.loss(fit.x, pixels_, {fit.x[kBlur], FitScope::Position});
    if (loss < least) least = loss, best = fit.x;
  }
  fit.x = best;
}

/// Loss of a pixel against the motion that is assumed: a parabola through three places. Of a ring, coarse and then
/// fine, since it is one near the least loss only, and together with the blur, which the edges along the motion tell.
/// Of a sleeve, blur and motion look too much alike.
void MarkerFitter::chooseMotion(MarkerFit& fit, const FitPrior& prior) {
  for (const double distance : kMotionTrials)
    if (!tryMotions(fit, prior, distance) || observed_[kRotation]) return;
}

/// @return false if they do not tell the motion
bool MarkerFitter::tryMotions(MarkerFit& fit, const FitPrior& prior, double distance) {
  const double max_motion = most_.length;
  const double middle = std::clamp(fit.motion.length, distance, std::max(max_motion - distance, distance));
  const MarkerFit start = fit;
  std::array<double, 3> loss{};
  for (int k = 0; k < 3; ++k) {
    MarkerFit trial = start;
    trial.motion = middle + (k - 1) * distance;
    prepare(trial, middle < kTellingMotion);
    for (int i = 0; i < (observed_[kRotation] ? 2 : 1); ++i) {
      fit_.evaluate(trial.x, pixels_);
      const FitScope scope = observed_[kRotation] ? FitScope::Shape : FitScope::All;
      const FitStep step = fit_.step(trial.x, prior, pixels_, {kMotionUncertainty, scope});
      if (!step.valid) return false;
      loss[k] = step.loss;
      take(step, trial);
    }
    if (k == 0 || loss[k] < *std::min_element(loss.begin(), loss.begin() + k)) fit = trial;
  }
  const double bend = loss[0] - 2 * loss[1] + loss[2];
  if (bend <= 0) return false;
  const double vertex = middle + distance * std::clamp((loss[0] - loss[2]) / (2 * bend), -1.5, 1.5);
  fit.motion = std::clamp(vertex, 0.0, max_motion);
  return true;
}

/// The motion that explains the pixels best.
void MarkerFitter::refineMotion(MarkerFit& fit, const FitPrior& prior, double max_motion) {
  double step = kMotionTrials[1];
  for (int i = 0; i < kMotionRefinements && std::abs(step) > kMotionRefined; ++i) {
    MarkerFit trial = fit;
    const double length = std::clamp(std::abs(fit.motion.length) + step, 1.0, max_motion);
    trial.motion.length = std::copysign(length, fit.motion.length);
    refine(trial, prior, 0, kAcquireSteps);
    const bool better = trial.loss < fit.loss;
    if (better) fit = trial;
    step *= better ? 1 : (i == 0 ? -1 : -0.5);
  }
  refine(fit, prior, 0, kAcquireSteps);
}

/// One frame hardly tells the light around a rod from its rotation and its place across the axis.
void MarkerFitter::doubtLight(MarkerFit& fit) {
  const SideLimits limits = sideLimits(fit);
  measureMotion(fit, limits);
  fit.covariance = fit_.covariance(pixels_, light_, limits) * std::max(1.0, fit.misfit);
  doubtCovered(fit);
}

Distortion MarkerFitter::stretch(const MarkerFit& fit, const FitPrior& unlearnt) {
  MarkerFit longer = fit;
  longer.motion.length += std::copysign(kMotionTrial, fit.motion.length);
  prepare(longer);
  fit_.measureMotion(0, pixels_, longer.motion.length - fit.motion.length);
  return fit_.stretch(unlearnt, pixels_);
}

/// Then it does not look like blur.
bool MarkerFitter::isMotionLong(const MarkerFit& fit) {
  return fit.loss < kWorthRefining && std::abs(fit.motion.length) > kTellingMotion;
}

}  // namespace vibe::vision
