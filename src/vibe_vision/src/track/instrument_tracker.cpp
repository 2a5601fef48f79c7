#include "track/instrument_tracker.hpp"

#include <algorithm>
#include <cmath>

#include "track/arithmetic.hpp"

namespace vibe::vision {
namespace {

/// Of a sleeve [px]; 0 of a ring.
double rodRadius(const InstrumentConfig& instrument) {
  const auto* sleeve = std::get_if<SleeveDesign>(&instrument.marker);
  return sleeve == nullptr ? 0 : sleeve->diameter / 2 * instrument.axis.pixels_per_metre;
}

MarkerFitter::MakePattern patternsOf(const InstrumentConfig& instrument, const MarkerView& view) {
  return [design = instrument.marker, scale = instrument.axis.pixels_per_metre, view](double ink) {
    return makePattern(printed(design, ink), scale, view);
  };
}

constexpr double kAnyTurn = M_PI * M_PI / 3;  // variance of a rotation of which nothing is known [rad^2]

double bandHalfWidth(const MarkerPattern& pattern, const InstrumentConfig& config) {
  return 1.1 * pattern.maxWindow().norm() + config.lateral_tolerance * config.axis.pixels_per_metre + 4;
}

}  // namespace

InstrumentTracker::InstrumentTracker(const VisionConfig& config, const InstrumentConfig& instrument,
                                     const TrackerPolicy& policy)
    : MarkerTracker(instrument, policy),
      view_(markerView(config.camera, instrument.axis)),
      min_contrast_(config.gates.min_contrast),
      fitter_(patternsOf(instrument, view_), instrument.ink, config.noise, rodRadius(instrument)),
      map_(config.camera, instrument.axis,
           alongOf(instrument.axis, instrument.lower) - 1.1 * fitter_.pattern().maxWindow().norm(),
           alongOf(instrument.axis, instrument.upper) + 1.1 * fitter_.pattern().maxWindow().norm(),
           bandHalfWidth(fitter_.pattern(), instrument)),
      search_(fitter_.pattern(), alongOf(instrument.axis, instrument.lower),
              alongOf(instrument.axis, instrument.upper)),
      gates_(config, instrument, policy),
      copies_(policy),
      slow_(config, instrument, fitter_.pattern().observes()),
      unknown_(slow_),
      rotation_(instrument.motion.max_angular_speed, 30 * instrument.motion.max_angular_speed) {}

void InstrumentTracker::reset() {
  rotation_.reset();
  slow_.reset();
  fitter_.forget();
  light_.reset();
  copies_.reset();
  lost_frames_ = followed_ = 0;
  MarkerTracker::reset();
}

const Measurement& InstrumentTracker::lose(LostReason reason) {
  const Measurement before = measurement_;
  MarkerTracker::lose(reason);
  measurement_.roi_x = before.roi_x, measurement_.roi_y = before.roi_y;
  measurement_.roi_width = before.roi_width, measurement_.roi_height = before.roi_height;
  if (++lost_frames_ == policy_.forget_after) {
    slow_.reset();
    fitter_.forget();
  }
  return measurement_;
}

const Measurement& InstrumentTracker::track(const Frame& frame) {
  const Prediction prediction = predict(frame.stamp);
  reason_ = LostReason::NotFound;
  tries_ = 0;
  if (leaveCopy(frame)) return measurement_;
  if (prediction.close && follow(frame, prediction)) return measurement_;
  if (search(frame, prediction)) return measurement_;
  return lose(reason_);
}

/// A stamp that goes back, or one much later, says nothing about where the marker may be now.
InstrumentTracker::Prediction InstrumentTracker::predict(double stamp) {
  Prediction p;
  if (slide_.started() && (stamp <= slide_.time() || stamp - slide_.time() > policy_.max_gap)) {
    slide_.reset();
    rotation_.reset();
  }
  if (!slide_.started()) return p;
  p.known = true;
  p.dt = stamp - slide_.time();
  p.slide = slide_.predict(stamp);
  if (rotation_.started()) p.rotation = rotation_.predict(stamp);
  p.turn = rotation_.started() && p.rotation.deviation() < policy_.known_rotation;
  p.close = p.slide.deviation() * pixelsPerMetre(config_.axis, p.slide.mean[0]) < policy_.close_enough;
  return p;
}

MarkerMotion InstrumentTracker::motionAt(const MotionFilter::State& slide, const MotionFilter::State& rotation,
                                         double exposure) const {
  const double scale = pixelsPerMetre(config_.axis, slide.mean[0]);
  return {slide.mean[1] * exposure * scale, slide.mean[2] * square(exposure) / 16 * scale, rotation.mean[1] * exposure};
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
                     prediction.slide.deviation() * scale, prediction.turn || !fitter_.shows(kRotation));
  if (fit.valid) correctMotion(frame, prior, fit);
  checkStripe(prior, prediction, fit);
  reason_ = gates_.judge(fit, slow_.nominal(slide), isNear(fit, prediction));
  if (reason_ == LostReason::None && !isExpected(fit, prediction, frame.stamp)) reason_ = LostReason::Jump;
  if (reason_ != LostReason::None) return false;
  accept(frame, fit, prediction, false);
  lookForDistortions(frame, fit);
  learnInk(fit, prior);
  stateDoubts(frame);
  lookForCopies(frame);
  return true;
}

/// Where the stripe is hidden, some of what hides it still agrees with it, anywhere: the rotation is then what was
/// known before, and the bars tell the place.
void InstrumentTracker::checkStripe(const FitPrior& prior, const Prediction& prediction, MarkerFit& fit) {
  fit.shows_turn = !fitter_.shows(kRotation) || !fit.valid || gates_.showsStripe(fit);
  if (!fit.shows_turn) fitter_.leaveStripe(fit, withTurn(prior, prediction));
}

/// What is known of the rotation without the stripe.
FitPrior InstrumentTracker::withTurn(const FitPrior& prior, const Prediction& prediction) const {
  const bool known = prediction.known && rotation_.started();
  FitPrior with = prior;
  with.mean[kRotation] = known ? prediction.rotation.mean[0] : last_rotation_;
  with.information(kRotation, kRotation) =
      1 / std::min(known ? prediction.rotation.covariance(0, 0) : kAnyTurn, kAnyTurn);
  return with;
}

/// Rows that are exposed one after the other shear the picture of a marker that moves along them. In the first frames
/// every picture is looked at. What covers a marker distorts it, too.
void InstrumentTracker::lookForDistortions(const Frame& frame, const MarkerFit& fit) {
  const double scale = pixelsPerMetre(config_.axis, last_slide_);
  const double speed = slide_.predict(frame.stamp).mean[1] * scale;
  if (fit.visible < policy_.good_look || std::abs(speed) < policy_.telling_speed * scale) return;
  if (++looks_ > policy_.first_looks && looks_ % policy_.look_every != 0) return;
  const FitPrior unlearnt = unknown_.prior(last_slide_);
  const Sight sight = sightAt(fit);
  const Distortions found = fitter_.distortions(unlearnt, sight);
  const int rarely = looks_ > policy_.first_looks ? policy_.look_every : 1;
  if (looks_ % (policy_.look_every * rarely) == 0 && std::abs(fit.motion.length) > policy_.telling_motion)
    doubts_.addExposure(fitter_.stretch(fit, unlearnt), fit.motion.length);
  const double uneven = fitter_.shows(kRotation) ? policy_.uneven * square(fit.x[kBlur]) : 0;
  doubts_.addBend(found.bend);
  doubts_.addOval(found.oval);
  doubts_.addRelief(found.relief, fitter_.pattern().rim(), sight.slope, uneven);
  if (fitter_.shows(kRotation))
    doubts_.addShear(found.shear, speed, fit.x[kTilt], fit.x[kRotation]);
  else
    doubts_.addShear(found.shear, speed);
}

/// In frames 2, 4, 8, ... that are followed. What was learnt of the look was learnt with other lines.
void InstrumentTracker::learnInk(const MarkerFit& fit, const FitPrior& prior) {
  ++followed_;
  const bool due = followed_ > 1 && (followed_ & (followed_ - 1)) == 0;
  if (due && fit.visible > policy_.whole_from && fitter_.learnInk(fit, prior)) slow_.reset();
}

Sight InstrumentTracker::sightAt(const MarkerFit& fit) const {
  const Eigen::Vector2d direction = config_.axis.direction;
  const double slant = fitter_.shows(kRotation) ? fit.x[kSlant] : slow_.nominal(last_slide_)[kSlant];
  const double slope = (fit.x[kAlong] - view_.principal_along) / view_.focal_length;
  return {{direction.y(), direction.x()},
          std::sin(slant) + std::cos(slant) * slope,
          1 / view_.focal_length,
          rodRadius(config_) * std::exp(fit.x[kLogScale])};
}

/// Of several, that which leaves least of the report, and then what the calibration is doubted for.
void InstrumentTracker::stateDoubts(const Frame& frame) {
  MarkerTracker::stateDoubts(slide_.predict(frame.stamp), pixelsPerMetre(config_.axis, last_slide_),
                             frame.sensor_height);
  Doubt& doubt = measurement_.doubt;
  if (!stripe_)
    doubt = Doubt::Stripe;
  else if (doubt != Doubt::None && doubt != Doubt::Unchecked)
    return;
  else if (copies_.doubted())
    doubt = Doubt::Copy;
  else if (broken_ || odd_rows_ > policy_.odd_rows)
    doubt = Doubt::Rows;
  else if (light_.surprise() > policy_.strange_light)
    doubt = Doubt::Light;
  else if (copies_.unchecked())
    doubt = Doubt::Unchecked;
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
  const bool same = std::abs(motion.length - fit.motion.length) < policy_.same_motion &&
                    std::abs(motion.bend - fit.motion.bend) < policy_.same_bend;
  if (!same && deviation < policy_.same_motion) fitter_.repeat(fit, prior, motion);
}

void InstrumentTracker::accept(const Frame& frame, const MarkerFit& fit, const Prediction& prediction,
                               bool reacquired) {
  measurement_ = {};
  measurement_.reason = LostReason::None;
  measurement_.reacquired = reacquired;
  stripe_ = fit.shows_turn;
  copies_.follow(fit.x[kAlong]);
  const double scale = pixelsPerMetre(config_.axis, slideOf(config_.axis, fit.x[kAlong]));
  measurement_.rotation = NAN;
  if (fitter_.shows(kRotation)) {
    const double expected = prediction.known && rotation_.started() ? prediction.rotation.mean[0] : last_rotation_;
    measurement_.rotation = fit.x[kRotation] - 2 * M_PI * std::round((fit.x[kRotation] - expected) / (2 * M_PI));
    measurement_.covariance(1, 1) = fit.covariance(kRotation, kRotation);
    measurement_.covariance(0, 1) = measurement_.covariance(1, 0) = fit.covariance(kAlong, kRotation) / scale;
  }
  updateFilters(frame.stamp, fit, scale, reach_.jumped() || !prediction.known);
  toMiddle(frame, fit, scale);
  measurement_.slide = slideOf(config_.axis, measurement_.along);
  describe(fit);
  // The covariance of a sleeve that was searched has the light and the motion in it.
  const double doubt = reacquired && !fitter_.shows(kRotation) ? policy_.search_doubt : 0;
  odd_rows_ = fitter_.oddRows(sightAt(fit));
  if (fit.visible > policy_.good_look) slow_.update(fit.x, fit.covariance, measurement_.slide, doubt);
  reach_.settle();
  lost_frames_ = 0;
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
  const double variance = fit.covariance(kAlong, kAlong) / square(scale) + square(policy_.filter_floor);
  last_slide_ = slideOf(config_.axis, fit.x[kAlong]);
  if (restart) slide_.start(stamp, last_slide_, variance);
  broken_ = !restart && slide_.update(stamp, last_slide_, variance);
  if (!fitter_.shows(kRotation) || !stripe_) return;
  const double turn_variance = fit.covariance(kRotation, kRotation) + square(1e3 * policy_.filter_floor);
  last_rotation_ = measurement_.rotation;
  if (restart || !rotation_.started())
    rotation_.start(stamp, last_rotation_, turn_variance);
  else
    rotation_.update(stamp, last_rotation_, turn_variance);
}

std::unique_ptr<MarkerTracker> makeInstrumentTracker(const VisionConfig& config, const InstrumentConfig& instrument,
                                                     const TrackerPolicy& policy) {
  return std::make_unique<InstrumentTracker>(config, instrument, policy);
}

}  // namespace vibe::vision
