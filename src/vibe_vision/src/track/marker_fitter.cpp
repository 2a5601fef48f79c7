#include "track/marker_fitter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "track/arithmetic.hpp"

namespace vibe::vision {

namespace {

constexpr std::size_t kMinPixels = 48;
constexpr double kConverged = 0.03;      // a step after which the next would change nothing that matters [px]
constexpr double kMaxStep = 3;           // [px]
constexpr double kMotionDoubt = 4;       // by which a predicted motion that explains little may be wrong [px]
constexpr double kLessUncertain = 5;     // uncertainty of the edges, from step to step
constexpr double kMinUncertainty = 0.3;  // of a prediction [px]
constexpr double kSureGamma = 0.01;      // standard deviation from which it is looked for no more
constexpr double kLeastGamma = 0.8, kMostGamma = 3;
// Changes after which the picture is made anew: of blur and motion [px], size, tilt and slant, of the place [px].
constexpr double kPrepareBlur = 0.05, kPrepareMotion = 0.01, kPrepareScale = 0.01, kPrepareTurn = 0.02;
constexpr double kPrepareSpin = 2e-3, kPreparePlace = 4;
// Of the ink, for its derivative, at most in a step, and from which it counts [m]; in standard deviations.
constexpr double kInkTrial = 5e-6, kMostInkStep = 3e-5, kLeastInk = 4e-6, kSureInk = 6;
constexpr double kInkDoubt = 0.3;                        // of the edges' places [px]
constexpr float kClipped = 253;                          // [DN]
constexpr double kSeenAsWhole = 0.9;                     // visible share of a marker that nothing covers
constexpr double kCoverShift = 0.12, kCoverTurn = 0.02;  // by what covers a sleeve [px], [rad]
constexpr double kQuarterEnough = 0.9;  // seen share of a marker from which a quarter of the pixels show where it is
constexpr int kFollowSteps = 12;        // a covered marker needs many
// A fit that still moves that far [px] with step 1, 2, ... is on something else: markers are well below half of it.
constexpr std::array<double, 4> kWandering = {1e9, 4, 1.5, 0.8};

std::size_t capacityOf(const MarkerPattern& pattern) {
  const Eigen::Vector2d window = pattern.maxWindow();
  // Distortion enlarges a little, a tilt the rectangle around it.
  return static_cast<std::size_t>(1.4 * (2.3 * window.x() + 8) * (2.3 * window.y() + 8));
}

}  // namespace

MarkerFitter::MarkerFitter(MakePattern make, double ink, const PixelNoise& noise, double rod_radius)
    : make_(std::move(make)),
      ink_(ink),
      pattern_(make_(ink)),
      inked_(make_(ink + kInkTrial)),
      observed_(pattern_->observes()),
      rotations_(pattern_->rotationGuesses()),
      radius_(pattern_->maxWindow().minCoeff() / 2),
      light_(rod_radius),
      fit_(*pattern_, noise, capacityOf(*pattern_)) {
  pixels_.allocate(capacityOf(*pattern_));
}

MarkerFit MarkerFitter::follow(AxisMap& map, const Frame& frame, const FitVector& start, const FitPrior& prior,
                               const MarkerMotion& motion, double uncertainty, bool known_rotation) {
  MarkerFit fit;
  fit.x = start;
  fit.motion = motion;
  if (!read(map, frame, fit)) return fit;
  prepare(fit);
  if (!known_rotation) {
    fit.loss = 1;
    choose(kRotation, rotations_, fit);
    if (!read(map, frame, fit)) return fit;
    prepare(fit);
  }
  usePixels(seen_ > kQuarterEnough ? 4 : 2);
  fit_.evaluate(fit.x, pixels_);
  fit_.startLevels(pixels_, fit.x);
  for (const FitScope scope : {FitScope::Position, FitScope::All}) {
    const double doubt = scope == FitScope::Position ? std::max(uncertainty, kMinUncertainty) : 0;
    if (scope == FitScope::All) fit_.evaluate(fit.x, pixels_);
    const FitStep step = fit_.step(fit.x, prior, pixels_, {doubt, scope});
    if (!step.valid) return fit;
    take(step, fit);
  }
  usePixels(1);
  refine(fit, prior, 0, kFollowSteps);
  if (fit.valid && fit.misfit > kStrangeMotion && isMotionLong(fit))
    refineMotion(fit, prior, std::abs(motion.length) + kMotionDoubt);
  seen_ = fit.visible;
  ink_known_ = ink_known_ || (fit.valid && fit.misfit < kStrangeMotion);
  if (light_.isRound() && fit.valid && std::min(fit.visible, fit.stripe_seen) > kLearnVisible) {
    usePixels(4);
    fit_.learnLight(fit.x, pixels_, light_);
    ++lit_frames_;
    usePixels(1);
  }
  return fit;
}

void MarkerFitter::repeat(MarkerFit& fit, const FitPrior& prior, const MarkerMotion& motion) {
  fit.motion = motion;
  usePixels(1);
  refine(fit, prior, 0, kFollowSteps);
}

void MarkerFitter::setInk(double ink) {
  ink_ = ink;
  pattern_ = make_(ink);
  inked_ = make_(ink + kInkTrial);
  fit_.usePattern(*pattern_);
  is_prepared_ = false;
}

/// Edges that are far from where they are expected are outliers of a fit: they count if the places of all edges are in
/// doubt, which is less exact. Both ways must agree.
bool MarkerFitter::learnInk(const MarkerFit& fit, const FitPrior& prior) {
  inked_->prepare(poseOf(fit.x), fit.motion);
  const Distortion exact = fit_.towards(*inked_, pixels_);
  fit_.step(fit.x, prior, pixels_, {kInkDoubt, FitScope::All});
  const Distortion coarse = fit_.towards(*inked_, pixels_);
  const auto isSure = [](const Distortion& d) { return square(d.value) > square(kSureInk) * d.variance; };
  const bool agree = square(exact.value - coarse.value) < square(kSureInk) * coarse.variance;
  const double change = (isSure(coarse) ? coarse.value : agree && isSure(exact) ? exact.value : 0) * kInkTrial;
  if (std::abs(change) < kLeastInk) return false;
  setInk(ink_ + std::clamp(change, -kMostInkStep, kMostInkStep));
  return true;
}

void MarkerFitter::leaveStripe(MarkerFit& fit, const FitPrior& prior) {
  hideStripe();  // where it was taken for the stripe, and where the stripe would be
  fit.x[kRotation] = prior.mean[kRotation];
  fit_.evaluate(fit.x, pixels_);
  hideStripe();
  refine(fit, prior, 0, kFollowSteps);
}

void MarkerFitter::hideStripe() {
  const std::vector<float>& slope = fit_.values().derivative[kRotation];
  for (std::size_t i = 0; i < pixels_.padded(); ++i)
    if (slope[i] != 0) pixels_.weight[i] = 0;
}

void MarkerFitter::forget() {
  light_.reset();
  lit_frames_ = ink_tries_ = 0;
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
  const bool same = is_prepared_ && rough == prepared_rough_ &&
                    std::abs(fit.motion.length - m.length) < kPrepareMotion &&
                    std::abs(fit.motion.bend - m.bend) < kPrepareMotion &&
                    std::abs(fit.motion.turn - m.turn) < kPrepareSpin && std::abs(pose.blur - p.blur) < kPrepareBlur &&
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
  const auto end = pixels_.value.begin() + static_cast<std::ptrdiff_t>(pixels_.count);
  const auto clipped = std::count_if(pixels_.value.begin(), end, [](float v) { return v >= kClipped; });
  fit.clipped = static_cast<double>(clipped) / std::max<double>(1, static_cast<double>(pixels_.count));
  useGamma(fit.x[kGamma]);
  if (gamma_ != 1) linearise();
  if (guess_light) light_.guess(pose, pixels_);
  pattern_->select(pose, fit.motion.length, pixels_);
  all_ = pixels_.count;
  light_.shine(pose, pixels_, pixels_.padded());
  if (!stripe_) {
    prepare(fit, true);
    fit_.evaluate(fit.x, pixels_);
    hideStripe();
  }
  return all_ >= kMinPixels;
}

/// The first half of the pixels that were read, or another part, which samples all of the window.
void MarkerFitter::usePixels(std::size_t one_of) {
  pixels_.count = one_of == 1 ? all_ : std::max(all_ / one_of / kLanes * kLanes, kMinPixels);
}

/// Steps with all parameters until they change no more.
void MarkerFitter::refine(MarkerFit& fit, const FitPrior& prior, double uncertainty, int max_steps) {
  const double known = prior.information(kGamma, kGamma);
  // While a straight response explains the picture, another one would explain its other errors, and move the marker.
  const bool response = fit.x[kGamma] != 1 && known > 0 && known * kSureGamma * kSureGamma < 1;
  for (int i = 0; i < max_steps; ++i) {
    prepare(fit);
    fit_.evaluate(fit.x, pixels_);
    FitStep step = fit_.step(fit.x, prior, pixels_, {uncertainty, FitScope::All, response});
    if (!step.valid) return;
    if (sides_.light > 0) stepWithSides(fit, step);
    const double last = uncertainty;
    take(step, fit);
    if (sides_.light > 0) light_.shine(poseOf(fit.x), pixels_, pixels_.padded());
    fit.misfit = step.misfit, fit.loss = step.loss, fit.visible = step.visible;
    fit.weaker_edges = step.weaker_edges;
    const double moved = lengthOf(step);
    // As long as the edges move, pixels near them are no outliers: weighed as such, they would keep the fit there.
    uncertainty = last > kConverged ? std::max(last / kLessUncertain, std::min(last, moved)) : 0;
    fit.valid = moved < kConverged && last == 0;
    if (fit.valid && observed_[kRotation]) fit.stripe_seen = fit_.stripeSeen(pixels_);
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
  const double blur = fit.x[kBlur];
  fit.x += step.change * std::min(1.0, kMaxStep / std::max(size, 1e-12));
  fit.x[kGamma] = std::clamp(fit.x[kGamma], kLeastGamma, kMostGamma);
  useGamma(fit.x[kGamma]);
  // A picture changes with the square of its blur: longer steps go to and fro.
  fit.x[kBlur] = std::clamp(fit.x[kBlur], std::max(0.05, blur / 2), std::min(4.0, 2 * blur));
}

}  // namespace vibe::vision
