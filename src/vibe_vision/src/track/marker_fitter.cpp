#include "track/marker_fitter.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vibe {
namespace {

constexpr std::size_t kMinPixels = 48;
constexpr double kConverged = 0.03;  // a step after which the next would change nothing that matters [px]
constexpr double kMaxStep = 3;       // [px]
constexpr double kMotionTrial = 2;   // [px]
constexpr double kPrepareBlur = 0.05, kPrepareScale = 0.01;  // changes after which the picture is made anew [px], 1
constexpr int kFollowSteps = 5, kAcquireSteps = 9;

std::size_t capacityOf(const MarkerPattern& pattern) {
  const Eigen::Vector2d window = pattern.maxWindow();
  return static_cast<std::size_t>((2.3 * window.x() + 8) * (2.3 * window.y() + 8));  // distortion enlarges a little
}

}  // namespace

MarkerFitter::MarkerFitter(std::unique_ptr<MarkerPattern> pattern, const PixelNoise& noise)
    : pattern_(std::move(pattern)),
      observed_(pattern_->observes()),
      rotations_(pattern_->rotationGuesses()),
      radius_(pattern_->maxWindow().minCoeff() / 2),
      fit_(*pattern_, noise, capacityOf(*pattern_)) {
  pixels_.allocate(capacityOf(*pattern_));
}

MarkerFit MarkerFitter::follow(AxisMap& map, const Frame& frame, const FitVector& start, const FitPrior& prior,
                               double motion, double uncertainty) {
  MarkerFit fit;
  fit.x = start;
  fit.motion = motion;
  if (!read(map, frame, fit)) return fit;
  pattern_->prepare(poseOf(fit.x), motion);
  const std::size_t all = pixels_.count;
  pixels_.count = std::max(all / 2 / kLanes * kLanes, std::min(all, kMinPixels));
  fit_.evaluate(fit.x, pixels_);
  fit_.startLevels(pixels_, fit.x);
  const FitStep step = fit_.step(fit.x, prior, pixels_, {std::max(uncertainty, 0.3), true});
  pixels_.count = all;
  if (!step.valid) return fit;
  take(step, fit);
  refine(fit, prior, kFollowSteps);
  return fit;
}

MarkerFit MarkerFitter::acquire(AxisMap& map, const Frame& frame, const FitVector& start, const FitPrior& prior,
                                double motion, double max_motion, bool known_rotation) {
  MarkerFit fit;
  fit.x = start;
  fit.motion = motion;
  if (!read(map, frame, fit)) return fit;
  const double blur = fit.x[kBlur];
  if (!alignCoarsely(fit, prior, blur + 2.4, 3)) return fit;
  if (!known_rotation && observed_[kRotation]) chooseRotation(fit, blur + 0.9);
  if (!read(map, frame, fit) || !alignCoarsely(fit, prior, blur + 0.9, 3)) return fit;
  if (max_motion > 1) chooseMotion(fit, prior, max_motion);
  fit.x[kBlur] = blur;
  if (!read(map, frame, fit)) return fit;
  refine(fit, prior, kAcquireSteps);
  return fit;
}

bool MarkerFitter::read(AxisMap& map, const Frame& frame, MarkerFit& fit) {
  const MarkerPose pose = poseOf(fit.x);
  fit.roi = map.gather(frame, {pose.along, pose.lateral}, pattern_->window(pose, fit.motion), pixels_);
  pattern_->select(pose, fit.motion, pixels_);
  return pixels_.count >= kMinPixels;
}

/// Position alone, with a picture that is more blurred than the camera's: its edges reach further.
bool MarkerFitter::alignCoarsely(MarkerFit& fit, const FitPrior& prior, double blur, int steps) {
  fit.x[kBlur] = blur;
  pattern_->prepare(poseOf(fit.x), fit.motion);
  for (int i = 0; i < steps; ++i) {
    fit_.evaluate(fit.x, pixels_);
    if (i == 0) fit_.startLevels(pixels_, fit.x);
    const FitStep step = fit_.step(fit.x, prior, pixels_, {blur, true});
    if (!step.valid) return false;
    take(step, fit);
  }
  return true;
}

void MarkerFitter::chooseRotation(MarkerFit& fit, double blur) {
  FitVector best = fit.x;
  double least = 1e9;
  fit.x[kBlur] = blur;
  pattern_->prepare(poseOf(fit.x), fit.motion);
  for (double rotation : rotations_) {
    fit.x[kRotation] = rotation;
    fit_.evaluate(fit.x, pixels_);
    fit_.startLevels(pixels_, fit.x);
    const double loss = fit_.loss(fit.x, pixels_, {blur, true});
    if (loss < least) least = loss, best = fit.x;
  }
  fit.x = best;
}

void MarkerFitter::chooseMotion(MarkerFit& fit, const FitPrior& prior, double max_motion) {
  MarkerFit best = fit;
  best.loss = 1e9;
  for (double change : {-kMotionTrial, 0.0, kMotionTrial}) {
    MarkerFit trial = fit;
    trial.motion = std::clamp(fit.motion + change, 0.0, max_motion);
    trial.x[kBlur] = prior.mean[kBlur];
    pattern_->prepare(poseOf(trial.x), trial.motion);
    for (int i = 0; i < 2; ++i) {
      fit_.evaluate(trial.x, pixels_);
      const FitStep step = fit_.step(trial.x, prior, pixels_, {0.3, true});
      if (!step.valid) break;
      trial.loss = step.loss;
      take(step, trial);
    }
    if (trial.loss > 0 && trial.loss < best.loss) best = trial;
  }
  if (best.loss < 1e9) fit = best;
}

/// Steps with all parameters until they change no more.
void MarkerFitter::refine(MarkerFit& fit, const FitPrior& prior, int max_steps) {
  pattern_->prepare(poseOf(fit.x), fit.motion);
  for (int i = 0; i < max_steps; ++i) {
    fit_.evaluate(fit.x, pixels_);
    const FitStep step = fit_.step(fit.x, prior, pixels_, {});
    if (!step.valid) return;
    take(step, fit);
    fit.covariance = step.covariance * std::max(1.0, step.misfit);
    fit.misfit = step.misfit, fit.loss = step.loss, fit.visible = step.visible;
    const double moved = std::max({std::abs(step.change[kAlong]), std::abs(step.change[kLateral]),
                                   radius_ * std::abs(step.change[kRotation]), std::abs(step.change[kBlur]) / 2,
                                   radius_ * std::abs(step.change[kLogScale]) / 2});
    fit.valid = moved < kConverged;
    if (fit.valid) return;
    if (std::abs(step.change[kBlur]) > kPrepareBlur || std::abs(step.change[kLogScale]) > kPrepareScale)
      pattern_->prepare(poseOf(fit.x), fit.motion);
  }
}

/// Goes the step, at most a few pixels at once.
void MarkerFitter::take(const FitStep& step, MarkerFit& fit) const {
  const double size = std::max({std::abs(step.change[kAlong]), std::abs(step.change[kLateral]),
                                radius_ * std::abs(step.change[kLogScale]), radius_ * std::abs(step.change[kRotation]),
                                radius_ * std::abs(step.change[kTilt])});
  fit.x += step.change * std::min(1.0, kMaxStep / std::max(size, 1e-12));
  fit.x[kBlur] = std::clamp(fit.x[kBlur], 0.05, 4.0);
}

}  // namespace vibe
