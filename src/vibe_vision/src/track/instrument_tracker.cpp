#include "track/instrument_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "track/arithmetic.hpp"

namespace vibe::vision {
namespace {

/// Of a sleeve [px]; 0 of a ring.
double rodRadius(const InstrumentConfig& instrument) {
  const auto* sleeve = std::get_if<SleeveDesign>(&instrument.marker);
  return sleeve == nullptr ? 0 : sleeve->diameter / 2 * instrument.axis.pixels_per_metre;
}

constexpr double kCloseEnough = 1.2;    // deviation of a prediction from which a fit converges [px]
constexpr double kMaxGap = 0.5;         // after which the motion is forgotten [s]
constexpr int kForget = 60;             // lost frames after which size, tilt and blur are forgotten
constexpr int kDoubt = 3;               // lost frames after which every other one is searched as if they were
constexpr int kJumpsToBelieve = 3;      // frames that agree on a place that cannot be reached
constexpr double kGoodLook = 0.6;       // share of the marker that must be seen to learn size, tilt and blur from it
constexpr double kScaleStep = 0.05;     // the search knows the size no better
constexpr double kMargin = 3;           // around the range of the search [px]
constexpr double kFilterFloor = 1e-6;   // deviation that a measurement has at least for the prediction [m], [rad] * 1e3
constexpr double kGoodLoss = 0.25;      // of a pixel: no other candidate needs to be looked at
constexpr int kTries = 3;               // candidates that a frame may cost
constexpr int kLostFramesToRelax = 15;  // lost frames after which it may cost one less: the best and one of the others
constexpr double kSearchVisible = 0.7;  // of a sleeve
constexpr double kWholeFrom = 0.88, kWhole = 0.94;     // visible share of a sleeve that is seen as a whole
constexpr double kPartMisfit = 1.5, kWholeMisfit = 4;  // that a search accepts of a part, of a whole sleeve
constexpr double kNearbyVisible = 0.5;                 // where the place is known well
constexpr double kKnownPlace = 3;                      // greatest deviation of a prediction that tells them apart [px]
constexpr double kKnownRotation = 0.3;  // greatest deviation of a prediction that a fit may start from [rad]
constexpr double kNear = 3;             // deviations of a prediction
constexpr double kNearbyReach = 2.5;    // the same
constexpr double kSameMotion = 0.2, kSameBend = 0.03;  // during the exposure, between prediction and fit [px]
constexpr int kFirstLooks = 16, kLookEvery = 4;        // frames; to look for a shear costs half a step of the fit
constexpr double kTellingSpeed = 0.05;                 // from which a picture would be sheared [m/s]
constexpr double kUncheckedShift = 2.5e-4;             // standard deviation that is worth a doubt [m]
constexpr double kUneven = 0.028;  // bars apart, by optics that blur not as a Gaussian, per square of the blur [1/px]
constexpr double kSearchDoubt = 0.1;  // about size, tilt and blur of a ring that a search found
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

double bandHalfWidth(const MarkerPattern& pattern, const InstrumentConfig& config) {
  return 1.1 * pattern.maxWindow().norm() + config.lateral_tolerance * config.axis.pixels_per_metre + 4;
}

/// The shift of a blurred marker's middle against its place at the middle of the exposure, per unit of acceleration:
/// the mean of t^2 / 2 over the exposure.
double exposureShift(double exposure) {
  return exposure * exposure / 24;
}

}  // namespace

InstrumentTracker::InstrumentTracker(const VisionConfig& config, const InstrumentConfig& instrument,
                                     std::unique_ptr<MarkerPattern> pattern)
    : config_(instrument),
      view_(markerView(config.camera, instrument.axis)),
      min_contrast_(config.gates.min_contrast),
      fitter_(std::move(pattern), config.noise, rodRadius(instrument)),
      map_(config.camera, instrument.axis,
           alongOf(instrument.axis, instrument.lower) - 1.1 * fitter_.pattern().maxWindow().norm(),
           alongOf(instrument.axis, instrument.upper) + 1.1 * fitter_.pattern().maxWindow().norm(),
           bandHalfWidth(fitter_.pattern(), instrument)),
      search_(fitter_.pattern(), alongOf(instrument.axis, instrument.lower),
              alongOf(instrument.axis, instrument.upper)),
      gates_(config, instrument),
      slow_(config, instrument, fitter_.pattern().observes()),
      unknown_(slow_),
      doubts_(instrument.axis.direction.x()),
      slide_(instrument.motion.max_speed, instrument.motion.max_acceleration),
      rotation_(instrument.motion.max_angular_speed, 30 * instrument.motion.max_angular_speed) {
  lose(LostReason::NoFrame);
}

void InstrumentTracker::reset() {
  slide_.reset();
  rotation_.reset();
  slow_.reset();
  fitter_.forget();
  light_.reset();
  doubts_.reset();
  jumps_ = lost_frames_ = 0;
  lose(LostReason::NoFrame);
}

const Measurement& InstrumentTracker::lose(LostReason reason) {
  const Measurement before = measurement_;
  measurement_ = {};
  measurement_.reason = reason;
  measurement_.slide = measurement_.rotation = measurement_.along = measurement_.lateral = kNaN;
  measurement_.pixel.setConstant(kNaN);
  measurement_.roi_x = before.roi_x, measurement_.roi_y = before.roi_y;
  measurement_.roi_width = before.roi_width, measurement_.roi_height = before.roi_height;
  if (++lost_frames_ == kForget) {
    slow_.reset();
    fitter_.forget();
  }
  return measurement_;
}

const Measurement& InstrumentTracker::track(const Frame& frame) {
  const Prediction prediction = predict(frame.stamp);
  reason_ = LostReason::NotFound;
  tries_ = 0;
  if (prediction.close && follow(frame, prediction)) return measurement_;
  if (search(frame, prediction)) return measurement_;
  return lose(reason_);
}

/// A stamp that goes back, or one much later, says nothing about where the marker may be now.
InstrumentTracker::Prediction InstrumentTracker::predict(double stamp) {
  Prediction p;
  if (slide_.started() && (stamp <= slide_.time() || stamp - slide_.time() > kMaxGap)) {
    slide_.reset();
    rotation_.reset();
  }
  if (!slide_.started()) return p;
  p.known = true;
  p.dt = stamp - slide_.time();
  p.slide = slide_.predict(stamp);
  if (rotation_.started()) p.rotation = rotation_.predict(stamp);
  p.close = p.slide.deviation() * pixelsPerMetre(config_.axis, p.slide.mean[0]) < kCloseEnough;
  return p;
}

MarkerMotion InstrumentTracker::motionAt(const MotionFilter::State& slide, const MotionFilter::State& rotation,
                                         double exposure) const {
  const double scale = pixelsPerMetre(config_.axis, slide.mean[0]);
  return {slide.mean[1] * exposure * scale, slide.mean[2] * square(exposure) / 16 * scale, rotation.mean[1] * exposure};
}

MarkerMotion InstrumentTracker::fastestMotion(const Frame& frame) const {
  const double scale = config_.axis.pixels_per_metre;
  return {config_.motion.max_speed * frame.exposure * scale,
          config_.motion.max_acceleration * square(frame.exposure) / 16 * scale,
          config_.motion.max_angular_speed * frame.exposure};
}

/// What was learnt may be wrong if it finds nothing.
FitPrior InstrumentTracker::searchPrior(double slide) const {
  const bool doubted = lost_frames_ >= kDoubt && lost_frames_ % 2 == 1;
  return doubted ? unknown_.prior(slide) : slow_.prior(slide);
}

FitVector InstrumentTracker::startAt(double slide, const FitPrior& prior, const Prediction& prediction) const {
  FitVector x = prior.mean;
  x[kAlong] = alongOf(config_.axis, slide);
  x[kRotation] = prediction.known && rotation_.started() ? prediction.rotation.mean[0] : last_rotation_;
  return x;
}

bool InstrumentTracker::follow(const Frame& frame, const Prediction& prediction) {
  const double slide = std::clamp(prediction.slide.mean[0], config_.lower, config_.upper);
  const double scale = pixelsPerMetre(config_.axis, slide);
  slow_.predict(prediction.slide.mean[1] * prediction.dt * scale);
  const FitPrior prior = slow_.prior(slide);
  FitVector start = startAt(slide, prior, prediction);
  start[kLateral] = measurement_.tracked() ? measurement_.lateral : 0;
  MarkerFit fit =
      fitter_.follow(map_, frame, start, prior, motionAt(prediction.slide, prediction.rotation, frame.exposure),
                     prediction.slide.deviation() * scale);
  if (fit.valid) correctMotion(frame, prior, fit);
  reason_ = gates_.judge(fit, slow_.nominal(slide), isNear(fit, prediction));
  if (reason_ == LostReason::None && !isExpected(fit, prediction, frame.stamp)) reason_ = LostReason::Jump;
  if (reason_ != LostReason::None) return false;
  accept(frame, fit, prediction, false);
  lookForDistortions(frame, fit);
  stateDoubts(frame);
  return true;
}

/// Rows that are exposed one after the other shear the picture of a marker that moves along them. In the first frames
/// every picture is looked at. What covers a marker distorts it, too.
void InstrumentTracker::lookForDistortions(const Frame& frame, const MarkerFit& fit) {
  const double scale = pixelsPerMetre(config_.axis, last_slide_);
  const double speed = slide_.predict(frame.stamp).mean[1] * scale;
  if (fit.visible < kGoodLook || std::abs(speed) < kTellingSpeed * scale) return;
  if (++looks_ > kFirstLooks && looks_ % kLookEvery != 0) return;
  const FitPrior unlearnt = unknown_.prior(last_slide_);
  const Sight sight = sightAt(fit);
  const Distortions found = fitter_.distortions(unlearnt, sight);
  const double uneven = fitter_.shows(kRotation) ? kUneven * square(fit.x[kBlur]) : 0;
  doubts_.addBend(found.bend);
  doubts_.addRelief(found.relief, fitter_.pattern().rim(), sight.slope, uneven);
  if (fitter_.shows(kRotation))
    doubts_.addShear(found.shear, speed, fit.x[kTilt], fit.x[kRotation]);
  else
    doubts_.addShear(found.shear, speed);
}

Sight InstrumentTracker::sightAt(const MarkerFit& fit) const {
  const Eigen::Vector2d direction = config_.axis.direction;
  const double slant = fitter_.shows(kRotation) ? fit.x[kSlant] : slow_.nominal(last_slide_)[kSlant];
  const double slope = (fit.x[kAlong] - view_.principal_along) / view_.focal_length;
  return {{direction.y(), direction.x()}, std::sin(slant) + std::cos(slant) * slope, 1 / view_.focal_length};
}

/// As long as nobody knows whether all rows are exposed at the same time, what moves fast may be elsewhere.
void InstrumentTracker::stateDoubts(const Frame& frame) {
  const Doubt doubt = doubts_.doubt();
  const MotionFilter::State state = slide_.predict(frame.stamp);
  const double scale = pixelsPerMetre(config_.axis, last_slide_);
  measurement_.along_variance += square(doubts_.shutterError(state.mean[1] * scale, frame.sensor_height));
  measurement_.covariance(0, 0) = measurement_.along_variance / square(scale);
  const double fastest = std::abs(state.mean[1]) + std::sqrt(state.covariance(1, 1));
  const bool known = doubts_.unknownShutterError(fastest, frame.sensor_height) < kUncheckedShift;
  measurement_.doubt = known || doubt == Doubt::Shutter ? doubt : Doubt::Unchecked;
}

/// Where the marker is now tells its speed during the exposure better than what was predicted.
void InstrumentTracker::correctMotion(const Frame& frame, const FitPrior& prior, MarkerFit& fit) {
  MotionFilter filter = slide_;
  const double slide = slideOf(config_.axis, fit.x[kAlong]);
  filter.update(frame.stamp, slide, fit.covariance(kAlong, kAlong) / square(pixelsPerMetre(config_.axis, slide)));
  const MotionFilter::State state = filter.predict(frame.stamp);
  MarkerMotion motion = motionAt(state, {}, frame.exposure);
  motion.turn = fit.motion.turn;
  const double deviation = std::sqrt(state.covariance(1, 1)) * frame.exposure * pixelsPerMetre(config_.axis, slide);
  const bool same =
      std::abs(motion.length - fit.motion.length) < kSameMotion && std::abs(motion.bend - fit.motion.bend) < kSameBend;
  if (!same && deviation < kSameMotion) fitter_.repeat(fit, prior, motion);
}

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
  if (deviation > kKnownPlace) return false;
  const FitPrior prior = slow_.prior(slide);
  const double motion = std::abs(motionAt(prediction.slide, prediction.rotation, frame.exposure).length);
  const bool known_rotation = prediction.rotation.deviation() < kKnownRotation;
  const MarkerFit fit = fitter_.acquire(map_, frame, startAt(slide, prior, prediction), prior, motion,
                                        fastestMotion(frame), known_rotation, kNearbyReach * deviation);
  if (gates_.judge(fit, slow_.nominal(slide)) != LostReason::None || fit.visible < kNearbyVisible) return false;
  if (!isNear(fit, prediction)) return false;
  accept(frame, fit, prediction, true);
  stateDoubts(frame);
  return true;
}

bool InstrumentTracker::searchRange(const Frame& frame, const Prediction& prediction, double begin, double end) {
  const double from = alongOf(config_.axis, std::max(begin, config_.lower));
  const double to = alongOf(config_.axis, std::min(end, config_.upper));
  const double fastest = fastestMotion(frame).length;
  const AxisSearch::Result& found = search_.run(map_, frame, from - kMargin, to + kMargin, fastest, min_contrast_);
  MarkerFit best;
  best.loss = 1e9;
  bool is_last = false;  // whose pixels the fitter has
  reason_ = whyNothing(found);
  const bool patient = lost_frames_ > kLostFramesToRelax;
  for (int i = 0; i < found.count && tries_ < (patient ? kTries - 1 : kTries); ++i, ++tries_) {
    const int other = patient && i > 0 ? 1 + lost_frames_ % (found.count - 1) : i;
    const MarkerFit fit = tryCandidate(frame, prediction, found.candidates[other]);
    LostReason reason = gates_.judge(fit, slow_.nominal(slideOf(config_.axis, fit.x[kAlong])), false);
    if (reason == LostReason::None && fitter_.shows(kRotation) && isPart(fit) && !isNear(fit, prediction))
      reason = LostReason::Occluded;
    const bool better = reason == LostReason::None && fit.loss < best.loss;
    if (better) best = fit;
    is_last = better;
    if (reason != LostReason::None && reason_ == LostReason::NotFound) reason_ = reason;
    if (best.valid && best.loss < kGoodLoss) break;
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
      prediction.known && rotation_.started() && prediction.rotation.deviation() < kKnownRotation;
  const FitPrior prior = searchPrior(slide);
  FitVector start = startAt(slide, prior, prediction);
  const double size = std::log(candidate.scale);
  if (std::abs(size - start[kLogScale]) > kScaleStep) start[kLogScale] = size;
  if (candidate.shows_rotation && !known_rotation) start[kRotation] = candidate.rotation;
  return fitter_.acquire(map_, frame, start, prior, candidate.motion, fastest,
                         known_rotation || candidate.shows_rotation);
}

/// Part of the bars also fits at other places, but not as well.
bool InstrumentTracker::isPart(const MarkerFit& fit) {
  const double whole = std::clamp((fit.visible - kWholeFrom) / (kWhole - kWholeFrom), 0.0, 1.0);
  return fit.visible < kSearchVisible || fit.misfit > kPartMisfit + whole * (kWholeMisfit - kPartMisfit);
}

/// Where else the bars would fit is further away.
bool InstrumentTracker::isNear(const MarkerFit& fit, const Prediction& prediction) const {
  if (!prediction.known) return false;
  const double deviation = prediction.slide.deviation() * pixelsPerMetre(config_.axis, prediction.slide.mean[0]);
  const double distance = std::abs(fit.x[kAlong] - alongOf(config_.axis, prediction.slide.mean[0]));
  return deviation < kKnownPlace && distance < kNear * deviation;
}

/// The instrument cannot be faster than it is; but if several frames agree on where it is now, somebody moved it.
bool InstrumentTracker::isExpected(const MarkerFit& fit, const Prediction& prediction, double stamp) {
  const double slide = slideOf(config_.axis, fit.x[kAlong]);
  if (!prediction.known || gates_.isReachable(slide, prediction.slide, last_slide_, prediction.dt)) return true;
  const double step = config_.motion.max_speed * std::abs(stamp - jump_stamp_) + 1e-4;
  jumps_ = jumps_ > 0 && std::abs(slide - jump_slide_) < step ? jumps_ + 1 : 1;
  jump_slide_ = slide, jump_stamp_ = stamp;
  return jumps_ >= kJumpsToBelieve;
}

LostReason InstrumentTracker::whyNothing(const AxisSearch::Result& found) const {
  if (!found.in_view) return LostReason::OutOfView;
  if (found.saturated > 0.5) return LostReason::Saturated;
  if (found.brightest < 2 * min_contrast_) return LostReason::Dark;
  return LostReason::NotFound;
}

void InstrumentTracker::accept(const Frame& frame, const MarkerFit& fit, const Prediction& prediction,
                               bool reacquired) {
  measurement_ = {};
  measurement_.reason = LostReason::None;
  measurement_.reacquired = reacquired;
  const double scale = pixelsPerMetre(config_.axis, slideOf(config_.axis, fit.x[kAlong]));
  measurement_.rotation = kNaN;
  if (fitter_.shows(kRotation)) {
    const double expected = prediction.known && rotation_.started() ? prediction.rotation.mean[0] : last_rotation_;
    measurement_.rotation = fit.x[kRotation] - 2 * M_PI * std::round((fit.x[kRotation] - expected) / (2 * M_PI));
    measurement_.covariance(1, 1) = fit.covariance(kRotation, kRotation);
    measurement_.covariance(0, 1) = measurement_.covariance(1, 0) = fit.covariance(kAlong, kRotation) / scale;
  }
  updateFilters(frame.stamp, fit, scale, jumps_ >= kJumpsToBelieve || !prediction.known);
  toMiddle(frame, fit, scale);
  measurement_.slide = slideOf(config_.axis, measurement_.along);
  describe(fit);
  // The covariance of a sleeve that was searched has the light and the motion in it.
  const double doubt = reacquired && !fitter_.shows(kRotation) ? kSearchDoubt : 0;
  if (fit.visible > kGoodLook) slow_.update(fit.x, fit.covariance, measurement_.slide, doubt);
  jumps_ = lost_frames_ = 0;
}

/// The picture shows where the marker was on average over the exposure, weighted by the light. From there to the middle
/// of the exposure.
void InstrumentTracker::toMiddle(const Frame& frame, const MarkerFit& fit, double scale) {
  const double grey = fit.x[kBlack] + fit.x[kContrast] / 2;
  const double place = 2 * (fit.x[kAlong] - search_.begin()) / (search_.end() - search_.begin()) - 1;
  light_.update(frame.stamp, place, grey, std::sqrt(fit.covariance(kContrast, kContrast)) / fit.x[kContrast]);
  const MotionFilter::State state = slide_.predict(frame.stamp);
  const LightModel::Delay delay = light_.delay(frame.stamp, frame.exposure);
  const double shift = exposureShift(frame.exposure);
  measurement_.along = fit.x[kAlong] - scale * (state.mean[2] * shift + state.mean[1] * delay.mean);
  const double doubt = state.covariance(2, 2) * square(shift) + square(state.mean[1]) * delay.variance +
                       state.covariance(1, 1) * (square(delay.mean) + delay.variance);
  measurement_.along_variance = fit.covariance(kAlong, kAlong) + square(scale) * doubt;
}

void InstrumentTracker::describe(const MarkerFit& fit) {
  const FitVector nominal = slow_.nominal(measurement_.slide);
  measurement_.lateral = fit.x[kLateral];
  measurement_.pixel = map_.pixel(measurement_.along, measurement_.lateral);
  measurement_.visible = std::min(fit.visible, 1.0);
  measurement_.score = measurement_.visible / std::max(1.0, fit.misfit);
  measurement_.scale = std::exp(fit.x[kLogScale] - nominal[kLogScale]);
  measurement_.tilt = fit.x[kTilt];
  measurement_.contrast = fit.x[kContrast];
  doubts_.addFit(std::log(measurement_.scale), std::log(fit.x[kGamma] / nominal[kGamma]));
  measurement_.roi_x = fit.roi.x, measurement_.roi_y = fit.roi.y;
  measurement_.roi_width = fit.roi.width, measurement_.roi_height = fit.roi.height;
}

/// The filters see what the picture shows: the mean over the exposure.
void InstrumentTracker::updateFilters(double stamp, const MarkerFit& fit, double scale, bool restart) {
  const double variance = fit.covariance(kAlong, kAlong) / square(scale) + square(kFilterFloor);
  last_slide_ = slideOf(config_.axis, fit.x[kAlong]);
  if (restart)
    slide_.start(stamp, last_slide_, variance);
  else
    slide_.update(stamp, last_slide_, variance);
  if (!fitter_.shows(kRotation)) return;
  const double turn_variance = fit.covariance(kRotation, kRotation) + square(1e3 * kFilterFloor);
  last_rotation_ = measurement_.rotation;
  if (restart || !rotation_.started())
    rotation_.start(stamp, last_rotation_, turn_variance);
  else
    rotation_.update(stamp, last_rotation_, turn_variance);
}

}  // namespace vibe::vision
