#include "track/marker_fitter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "track/arithmetic.hpp"

namespace vibe::vision {

namespace {

constexpr std::size_t kMinPixels = 48;
constexpr double kConverged = 0.03;         // a step after which the next would change nothing that matters [px]
constexpr double kMaxStep = 3;              // [px]
constexpr double kAligned = 0.2;            // the same of a step of the coarse alignment [px]
constexpr double kMotionTrials[] = {2, 1};  // [px]
constexpr double kTellingMotion = 6;        // from which what is seen where edges meet tells the motion [px]
constexpr int kMotionRefinements = 10;      // trials of a motion,
constexpr double kStrangeMotion = 1.5, kMotionDoubt = 4;  // misfit from which a predicted one is wrong, by up to [px]
constexpr double kWorthRefining = 0.35;                   // loss of a pixel up to which it may be the marker
constexpr double kMotionRefined = 0.2;                    // until a step is this short [px]
constexpr double kLateralTrial = 1.5;                     // [px]
constexpr int kLateralTrials = 6;
constexpr double kBendStep = 0.1;                       // [px]
constexpr double kGuessedLight = 0.05;                  // standard deviation of the light on a rod, after one frame
constexpr double kMotionUncertainty = 0.3;              // of the edges while it is tried [px]
constexpr double kLessUncertain = 5;                    // of that, from step to step
constexpr double kMinUncertainty = 0.3;                 // of a prediction [px]
constexpr double kCoarseBlur = 2.4, kMiddleBlur = 0.9;  // more than the camera's [px]
constexpr double kSureGamma = 0.01;                     // standard deviation from which it is looked for no more
constexpr double kLeastGamma = 0.8, kMostGamma = 3;
constexpr double kUnknownGamma = 0.1;  // standard deviation from which a search tries another one,
constexpr double kCommonGamma = 2.2;   // that of many cameras
constexpr double kStrange = 2.5;       // misfit from which the response may be why,
constexpr double kStrangeRod = 2.1;    // the same of a rod,
constexpr double kStrangeSheen = 1.4;  // the same of a rod whose light is known in detail
constexpr double kBothEdges = 0.6;     // of the share of all edges: a curve moves white and black ones apart
constexpr double kLearnVisible = 0.8;  // share of a rod that must be seen to learn the light on it
constexpr double kLearnSheen = 0.6;    // the same before the line of the lamp on it is known well
constexpr int kGuessAfter = 3;         // tries after which what was learnt of the light is doubted
constexpr double kHopeless = 0.8;      // loss of a pixel after the coarse alignment
constexpr double kVeryHopeless = 0.8;  // before size and tilt are known
constexpr double kPoor = 0.25;         // loss of a pixel from which the rotation may be wrong
constexpr int kAlignSteps = 3;
// Changes after which the picture is made anew: of blur and motion [px], size, tilt and slant, of the place [px].
constexpr double kPrepareBlur = 0.05, kPrepareMotion = 0.01, kPrepareScale = 0.01, kPrepareTurn = 0.02;
constexpr double kPreparePlace = 4;
constexpr double kPlaceTrial = 1.5;                      // [px]
constexpr double kSeenAsWhole = 0.9;                     // visible share of a marker that nothing covers
constexpr double kCoverShift = 0.12, kCoverTurn = 0.02;  // by what covers a sleeve [px], [rad]
constexpr double kQuarterEnough = 0.9;  // seen share of a marker from which a quarter of the pixels show where it is
constexpr int kFollowSteps = 12, kAcquireSteps = 14;  // a covered marker needs many
// A fit that still moves that far [px] with step 1, 2, ... is on something else: markers are well below half of it.
constexpr std::array<double, 4> kWandering = {1e9, 4, 1.5, 0.8};

std::size_t capacityOf(const MarkerPattern& pattern) {
  const Eigen::Vector2d window = pattern.maxWindow();
  // Distortion enlarges a little, a tilt the rectangle around it.
  return static_cast<std::size_t>(1.4 * (2.3 * window.x() + 8) * (2.3 * window.y() + 8));
}

}  // namespace

MarkerFitter::MarkerFitter(std::unique_ptr<MarkerPattern> pattern, const PixelNoise& noise, double rod_radius)
    : pattern_(std::move(pattern)),
      observed_(pattern_->observes()),
      rotations_(pattern_->rotationGuesses()),
      radius_(pattern_->maxWindow().minCoeff() / 2),
      light_(rod_radius),
      fit_(*pattern_, noise, capacityOf(*pattern_)) {
  pixels_.allocate(capacityOf(*pattern_));
}

MarkerFit MarkerFitter::follow(AxisMap& map, const Frame& frame, const FitVector& start, const FitPrior& prior,
                               const MarkerMotion& motion, double uncertainty) {
  MarkerFit fit;
  fit.x = start;
  fit.motion = motion;
  if (!read(map, frame, fit)) return fit;
  prepare(fit);
  seen_ > kQuarterEnough ? useQuarter() : useHalf();
  fit_.evaluate(fit.x, pixels_);
  fit_.startLevels(pixels_, fit.x);
  for (const FitScope scope : {FitScope::Position, FitScope::All}) {
    const double doubt = scope == FitScope::Position ? std::max(uncertainty, kMinUncertainty) : 0;
    if (scope == FitScope::All) fit_.evaluate(fit.x, pixels_);
    const FitStep step = fit_.step(fit.x, prior, pixels_, {doubt, scope});
    if (!step.valid) return fit;
    take(step, fit);
  }
  useAll();
  refine(fit, prior, 0, kFollowSteps);
  if (fit.valid && fit.misfit > kStrangeMotion && isMotionLong(fit))
    refineMotion(fit, prior, std::abs(motion.length) + kMotionDoubt);
  seen_ = fit.visible;
  if (light_.isRound() && fit.valid && fit.visible > kLearnVisible) {
    useQuarter();
    fit_.learnLight(fit.x, pixels_, light_);
    useAll();
  }
  return fit;
}

void MarkerFitter::repeat(MarkerFit& fit, const FitPrior& prior, const MarkerMotion& motion) {
  fit.motion = motion;
  useAll();
  refine(fit, prior, 0, kFollowSteps);
}

MarkerFit MarkerFitter::acquire(AxisMap& map, const Frame& frame, const FitVector& start, const FitPrior& prior,
                                double motion, const MarkerMotion& most, bool known_rotation, double reach) {
  const double max_motion = most.length;
  most_bend_ = most.bend;
  MarkerFit fit = acquireWithAnyResponse(map, frame, start, prior, motion, max_motion, known_rotation, reach);
  // Only now: another motion would also explain some of what a response does.
  const bool strange = light_.isRound() && fit.valid && fit.misfit > kStrangeMotion && !isMotionLong(fit);
  if (strange && max_motion > 1 && fit.loss < kWorthRefining && read(map, frame, fit))
    refineMotion(fit, prior, max_motion);
  return fit;
}

MarkerFit MarkerFitter::acquireWithAnyResponse(AxisMap& map, const Frame& frame, const FitVector& start,
                                               const FitPrior& prior, double motion, double max_motion,
                                               bool known_rotation, double reach) {
  const MarkerFit fit = tryToAcquire(map, frame, start, prior, motion, max_motion, known_rotation, reach);
  const double known = prior.information(kGamma, kGamma);
  const auto explains = [this](const MarkerFit& f) {
    const double strange = light_.shines() ? kStrangeSheen : (light_.isRound() ? kStrangeRod : kStrange);
    return f.valid && f.loss < kPoor && f.misfit < strange && f.weaker_edges > kBothEdges * f.visible;
  };
  if (explains(fit) || seen_ > 0 || known == 0 || known * kUnknownGamma * kUnknownGamma > 1) return fit;
  FitVector other = start;
  other[kGamma] = kCommonGamma;
  const MarkerFit second = tryToAcquire(map, frame, other, prior, motion, max_motion, known_rotation, reach);
  return explains(second) && (!fit.valid || second.loss < fit.loss) ? second : fit;
}

MarkerFit MarkerFitter::tryToAcquire(AxisMap& map, const Frame& frame, const FitVector& start, const FitPrior& prior,
                                     double motion, double max_motion, bool known_rotation, double reach) {
  MarkerFit fit;
  fit.x = start;
  fit.motion = motion;
  const double blur = fit.x[kBlur];
  // The search knows the place of a sleeve well, and its bars would vanish.
  fit.x[kBlur] = blur + (observed_[kRotation] ? kMiddleBlur : kCoarseBlur);
  const bool guess = !light_.known() || ++tries_ > kGuessAfter;
  if (!read(map, frame, fit, guess)) return fit;
  observed_[kRotation] ? useHalf() : useQuarter();
  if (reach > 0) choosePlace(fit, reach);
  if (!align(fit, prior, FitScope::Position)) return fit;
  if (!observed_[kRotation] && fit.loss > kVeryHopeless) return fit;  // else the rotation may be wrong
  fit.x[kBlur] = blur + kMiddleBlur;
  if (observed_[kRotation] && (!known_rotation || fit.loss > kPoor)) chooseRotation(fit);
  if (!read(map, frame, fit)) return fit;
  observed_[kRotation] ? useHalf() : useQuarter();
  if (!align(fit, prior, FitScope::Shape) || fit.loss > kHopeless) return fit;
  // The blur is not that of the prior if the camera is out of focus: edges along the motion tell it, and thin bars.
  if (!align(fit, prior, FitScope::All)) return fit;
  if (max_motion > 1) chooseMotion(fit, prior, max_motion);
  if (!read(map, frame, fit)) return fit;
  refine(fit, prior, kMotionUncertainty, kAcquireSteps);
  if (isMotionLong(fit)) refineMotion(fit, prior, max_motion);
  if (!light_.isRound()) return fit;
  const int rounds = !guess ? 0 : (light_.shines() ? 2 : 1);
  for (int i = 0; i < rounds && fit.visible > (light_.shines() ? kLearnSheen : kLearnVisible); ++i) {
    learnLight(fit);
    refine(fit, prior, 0, kAcquireSteps);
    if (fit.valid) tries_ = 0;
  }
  if (isMotionLong(fit) && fit.visible >= kLearnVisible) {
    learnLight(fit);
    refineMotion(fit, prior, max_motion);
    if (fit.valid) chooseLateral(fit, prior);
    if (fit.valid) solveBend(fit, prior);
  }
  if (fit.valid && fit.visible > kLearnSheen) doubtLight(fit);
  return fit;
}

void MarkerFitter::learnLight(const MarkerFit& fit) {
  fit_.learnLight(fit.x, pixels_, light_);
  light_.shine(poseOf(fit.x), pixels_, pixels_.padded());
}

void MarkerFitter::forget() {
  light_.reset();
  seen_ = 0;
  is_prepared_ = false;
}

/// From what is seen to what grows with the light.
void MarkerFitter::linearise() {
  if (gamma_ != table_gamma_)
    for (int v = 0; v < 256; ++v) linear_[v] = static_cast<float>(255 * std::pow(v / 255.0, gamma_));
  table_gamma_ = gamma_;
  for (std::size_t i = 0; i < pixels_.count; ++i)
    pixels_.value[i] = linear_[static_cast<std::size_t>(pixels_.value[i])];
}

/// The pixels and the light in the grey values of another gamma.
void MarkerFitter::useGamma(double gamma) {
  if (gamma == gamma_) return;
  const auto power = static_cast<float>(gamma / gamma_);
  const auto sheen = static_cast<float>(light_.raise(gamma / gamma_));
  const std::size_t count = (all_ + kLanes - 1) / kLanes * kLanes;
  for (std::size_t i = 0; i < count; ++i) {
    pixels_.value[i] = 255 * std::pow(pixels_.value[i] / 255, power);
    if (light_.isRound()) pixels_.light[i] = std::pow(pixels_.light[i], power), pixels_.sheen[i] *= sheen;
  }
  gamma_ = gamma;
}

/// The pattern's picture, unless there is one for much the same.
void MarkerFitter::prepare(const MarkerFit& fit, bool rough) {
  const MarkerPose pose = poseOf(fit.x);
  const MarkerPose& p = prepared_;
  const MarkerMotion& m = prepared_motion_;
  const bool same =
      is_prepared_ && rough == prepared_rough_ && std::abs(fit.motion.length - m.length) < kPrepareMotion &&
      std::abs(fit.motion.bend - m.bend) < kPrepareMotion && std::abs(pose.blur - p.blur) < kPrepareBlur &&
      std::abs(pose.log_scale - p.log_scale) + std::abs(pose.log_aspect - p.log_aspect) < kPrepareScale &&
      std::abs(pose.tilt - p.tilt) + std::abs(pose.slant - p.slant) < kPrepareTurn &&
      std::abs(pose.along - p.along) < kPreparePlace;
  if (same) return;
  pattern_->prepare(pose, fit.motion, rough);
  prepared_ = pose;
  prepared_motion_ = fit.motion;
  prepared_rough_ = rough;
  is_prepared_ = true;
}

bool MarkerFitter::read(AxisMap& map, const Frame& frame, MarkerFit& fit, bool guess_light) {
  const MarkerPose pose = poseOf(fit.x);
  fit.roi = map.gather(frame, {pose.along, pose.lateral}, pattern_->window(pose, fit.motion.length), pixels_);
  all_ = 0;
  useGamma(fit.x[kGamma]);
  if (gamma_ != 1) linearise();
  if (guess_light) light_.guess(pose, pixels_);
  pattern_->select(pose, fit.motion.length, pixels_);
  all_ = pixels_.count;
  light_.shine(pose, pixels_, pixels_.padded());
  return all_ >= kMinPixels;
}

void MarkerFitter::useHalf() {
  pixels_.count = std::max(all_ / 2 / kLanes * kLanes, kMinPixels);
}

void MarkerFitter::useQuarter() {
  pixels_.count = std::max(all_ / 4 / kLanes * kLanes, kMinPixels);
}

void MarkerFitter::useAll() {
  pixels_.count = all_;
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
  const FitVector start = fit.x;
  FitVector best = start;
  const int steps = static_cast<int>(std::ceil(reach / kPlaceTrial));
  double least = 2;
  prepare(fit, true);
  for (int k = -steps; k <= steps; ++k) {
    fit.x[kAlong] = start[kAlong] + k * kPlaceTrial;
    fit_.evaluate(fit.x, pixels_);
    fit_.startLevels(pixels_, fit.x);
    const double loss = fit_.loss(fit.x, pixels_, {fit.x[kBlur], FitScope::Position});
    if (loss < least) least = loss, best = fit.x;
  }
  fit.x = best;
}

/// The rotation with the least loss; that of the start stays if no other is better.
void MarkerFitter::chooseRotation(MarkerFit& fit) {
  FitVector best = fit.x;
  prepare(fit, true);
  double least = fit.loss;
  for (double rotation : rotations_) {
    fit.x[kRotation] = rotation;
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
void MarkerFitter::chooseMotion(MarkerFit& fit, const FitPrior& prior, double max_motion) {
  for (const double distance : kMotionTrials)
    if (!tryMotions(fit, prior, max_motion, distance) || observed_[kRotation]) return;
}

/// @return false if they do not tell the motion
bool MarkerFitter::tryMotions(MarkerFit& fit, const FitPrior& prior, double max_motion, double distance) {
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

/// Then it does not look like blur.
bool MarkerFitter::isMotionLong(const MarkerFit& fit) {
  return fit.loss < kWorthRefining && std::abs(fit.motion.length) > kTellingMotion;
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

/// A Gauss-Newton step of the acceleration during the exposure, which a long motion shows.
void MarkerFitter::solveBend(MarkerFit& fit, const FitPrior& prior) {
  MarkerFit trial = fit;
  trial.motion.bend += kBendStep;
  prepare(trial);
  const PatternFit::Nuisance found = fit_.nuisance(pixels_, kBendStep);
  if (found.change.variance <= 0 || most_bend_ <= 0) return;
  const double told = 1 / found.change.variance, known = 4 / square(most_bend_);
  const double change = (told * found.change.value - known * fit.motion.bend) / (told + known);
  fit.motion.bend += change;
  fit.x += change * found.others;
  refine(fit, prior, 0, kAcquireSteps);
}

/// Where a rod is across the axis and how it is turned look nearly the same: other places along that valley.
void MarkerFitter::chooseLateral(MarkerFit& fit, const FitPrior& prior) {
  double step = kLateralTrial;
  for (int i = 0; i < kLateralTrials; ++i) {
    MarkerFit trial = fit;
    trial.x += step / fit.covariance(kLateral, kLateral) * fit.covariance.col(kLateral);
    refine(trial, prior, 0, kAcquireSteps);
    const bool better = trial.valid && trial.loss < fit.loss;
    if (better) {
      fit = trial;
      learnLight(fit);
    } else if (step < 0) {
      break;
    } else {
      step = -step;
    }
  }
  refine(fit, prior, 0, kAcquireSteps);
}

/// Steps with all parameters until they change no more.
void MarkerFitter::refine(MarkerFit& fit, const FitPrior& prior, double uncertainty, int max_steps) {
  const double known = prior.information(kGamma, kGamma);
  // While a straight response explains the picture, another one would explain its other errors, and move the marker.
  const bool response = fit.x[kGamma] != 1 && known > 0 && known * kSureGamma * kSureGamma < 1;
  for (int i = 0; i < max_steps; ++i) {
    prepare(fit);
    fit_.evaluate(fit.x, pixels_);
    const FitStep step = fit_.step(fit.x, prior, pixels_, {uncertainty, FitScope::All, response});
    if (!step.valid) return;
    const double last = uncertainty;
    uncertainty = uncertainty > kConverged ? uncertainty / kLessUncertain : 0;
    take(step, fit);
    fit.misfit = step.misfit, fit.loss = step.loss, fit.visible = step.visible;
    fit.weaker_edges = step.weaker_edges;
    const double moved = lengthOf(step);
    fit.valid = moved < kConverged && last == 0;
    if (fit.valid) return stateCovariance(fit);
    if (moved > kWandering[std::min<std::size_t>(i, kWandering.size() - 1)]) return;
  }
}

/// By how much it moves edges [px].
double MarkerFitter::lengthOf(const FitStep& step) const {
  return std::max({std::abs(step.change[kAlong]), std::abs(step.change[kLateral]),
                   radius_ * std::abs(step.change[kRotation]), std::abs(step.change[kBlur]) / 2,
                   radius_ * std::abs(step.change[kLogScale]) / 2});
}

void MarkerFitter::stateCovariance(MarkerFit& fit) const {
  fit.covariance = fit_.covariance() * std::max(1.0, fit.misfit);
  if (observed_[kRotation]) doubtCovered(fit);
}

/// One frame hardly tells the light around a rod from its rotation and its place across the axis.
void MarkerFitter::doubtLight(MarkerFit& fit) const {
  fit.covariance = fit_.covariance(pixels_, light_, kGuessedLight) * std::max(1.0, fit.misfit);
  doubtCovered(fit);
}

/// The picture of what covers a part of a sleeve draws the fit aside, which the noise does not tell.
void MarkerFitter::doubtCovered(MarkerFit& fit) {
  const double covered = std::max(kSeenAsWhole - fit.visible, 0.0);
  fit.covariance(kAlong, kAlong) += std::pow(kCoverShift * covered, 2);
  fit.covariance(kRotation, kRotation) += std::pow(kCoverTurn * covered, 2);
}

/// Goes the step, at most a few pixels at once.
void MarkerFitter::take(const FitStep& step, MarkerFit& fit) {
  const double size = std::max({std::abs(step.change[kAlong]), std::abs(step.change[kLateral]),
                                radius_ * std::abs(step.change[kLogScale]), radius_ * std::abs(step.change[kRotation]),
                                radius_ * std::abs(step.change[kTilt])});
  fit.x += step.change * std::min(1.0, kMaxStep / std::max(size, 1e-12));
  fit.x[kGamma] = std::clamp(fit.x[kGamma], kLeastGamma, kMostGamma);
  useGamma(fit.x[kGamma]);
  fit.x[kBlur] = std::clamp(fit.x[kBlur], 0.05, 4.0);
}

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
