#include "track/outcome.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "track/arithmetic.hpp"

namespace vibe::vision {

namespace {

struct Words {
  const char* word;      ///< for tables
  const char* sentence;  ///< for people
};

/// By LostReason.
constexpr Words kReasons[] = {
    {"", "tracked"},
    {"not_found", "nothing along the axis looks like the marker"},
    {"occluded", "too little of the marker is visible"},
    {"saturated", "the image is too bright"},
    {"dark", "the image is too dark"},
    {"mismatch", "pattern, size or tilt is not that of the marker"},
    {"jump", "it would have moved faster than the instrument can"},
    {"out_of_view", "the marker leaves the image"},
    {"wrong_image", "the image does not have the size of the calibration"},
    {"no_frame", "no image"},
};

/// By Doubt.
constexpr Words kDoubts[] = {
    {"", ""},
    {"size",
     "the marker is not as large as calibrated: the camera may have moved or have another lens, or the print another "
     "size; calibrate the axis anew, or correct the size"},
    {"shutter",
     "the picture of the moving marker is sheared, as by a rolling shutter; use a camera with a global shutter"},
    {"unchecked",
     "the marker has not moved since it was found, so that it may be a copy, or too few fast frames have been seen to "
     "exclude a rolling shutter; move the instrument to and fro"},
    {"askew",
     "the tilt of the sleeve's bars changes with its rotation: it may be glued askew, which moves its slide with the "
     "rotation; glue it anew, its ends at right angles to the rod"},
    {"bent",
     "the marker is bent or its ends stand off: a ring is shortened towards two of its sides, or the ends of a marker "
     "are not as far from the camera as its middle; glue it anew, a ring on something flat"},
    {"response",
     "the grey values do not grow with the light as configured: set camera.gamma to the camera's response, or switch "
     "its gamma correction off"},
    {"noise",
     "the pictures are clearly noisier than configured: set camera.noise to the gain in use, or give more light; what "
     "is measured counts until then"},
    {"oval",
     "the sleeve is wider in one direction than in the other, which moves its rotation: it may be pressed or glued "
     "with a fold; glue it anew, on a round rod"},
    {"exposure",
     "the picture of the moving marker is blurred more or less than its speed and the exposure say: the exposure may "
     "not be the one that was told; set it to that of the camera"},
    {"light",
     "the brightness changes more than a lamp on the mains makes it: it may flicker strongly, or another light be "
     "switched; use a lamp on direct current"},
    {"rows",
     "rows of the picture do not belong together, or the marker moved as the instrument cannot: rows may be lost or "
     "of an earlier picture, a thing along the axis may cover some, or the instrument has hit something; check the "
     "connection of the camera"},
    {"copy",
     "something else on the axis looks like the marker, or the marker came back elsewhere than it was lost, and what "
     "is followed has not moved since: it may be a copy or a reflection; move the instrument, and take the other away"},
    {"stripe",
     "the stripe that tells the rotation is not seen where the bars are, so that the rotation is only a guess: it "
     "may be covered, saturated, of another print, or the picture mirrored; uncover it, or compare the print with "
     "its design"},
};

template <class Enum, std::size_t count>
Words wordsOf(const Words (&table)[count], Enum value) {
  const auto i = static_cast<std::size_t>(value);
  return i < count ? table[i] : Words{"unknown", "unknown"};
}

}  // namespace

const char* toText(LostReason reason) {
  return wordsOf(kReasons, reason).sentence;
}

const char* toWord(LostReason reason) {
  return wordsOf(kReasons, reason).word;
}

const char* toText(Doubt doubt) {
  return wordsOf(kDoubts, doubt).sentence;
}

const char* toWord(Doubt doubt) {
  return wordsOf(kDoubts, doubt).word;
}

LostReason whyNothing(const BandLight& light, double min_contrast, const TrackerPolicy& policy) {
  if (!light.in_view) return LostReason::OutOfView;
  if (light.saturated > policy.saturated_share) return LostReason::Saturated;
  return light.brightest < policy.dark_contrasts * min_contrast ? LostReason::Dark : LostReason::NotFound;
}

void Copies::find(double along, bool lost) {
  const bool elsewhere = known_ && lost && std::abs(along - along_) > policy_.copy_moved;
  if (!elsewhere && known_) return;
  suspect_ = elsewhere;
  moved_ = false;
  known_ = true;
  anchor_ = along;
}

void Copies::follow(double along) {
  along_ = along;
  if (!known_) anchor_ = along;
  known_ = true;
  if (std::abs(along - anchor_) > policy_.copy_moved) moved_ = true;
}

void Copies::see(double along) {
  if (isAt(along)) return;
  std::rotate(places_.rbegin(), places_.rbegin() + 1, places_.rend());
  places_.front() = along;
  count_ = std::min(count_ + 1, places_.size());
}

void Copies::forget(double from, double to, double own, double apart) {
  const auto end = places_.begin() + static_cast<std::ptrdiff_t>(count_);
  const auto gone = [&](double p) { return p >= from && p <= to && std::abs(p - own) > apart; };
  count_ = static_cast<std::size_t>(std::remove_if(places_.begin(), end, gone) - places_.begin());
}

bool Copies::isAt(double along) const {
  const auto end = places_.begin() + static_cast<std::ptrdiff_t>(count_);
  return std::any_of(places_.begin(), end, [&](double p) { return std::abs(p - along) <= policy_.copy_moved; });
}

bool Reach::contains(double slide, const MotionFilter::State& predicted, double last_slide, double dt) const {
  const double travel = max_speed_ * dt + policy_.rest;
  return std::abs(slide - last_slide) <= travel ||
         std::abs(slide - predicted.mean[0]) <= policy_.reach_deviations * predicted.deviation();
}

bool Reach::believes(double slide, double stamp, const MotionFilter::State& predicted, double last_slide, double dt) {
  if (contains(slide, predicted, last_slide, dt)) return true;
  const double step = max_speed_ * std::abs(stamp - jump_stamp_) + policy_.rest;
  jumps_ = jumps_ > 0 && std::abs(slide - jump_slide_) < step ? jumps_ + 1 : 1;
  jump_slide_ = slide, jump_stamp_ = stamp;
  return jumped();
}

MarkerTracker::MarkerTracker(const InstrumentConfig& instrument, const TrackerPolicy& policy)
    : config_(instrument),
      policy_(policy),
      reach_(instrument.motion.max_speed, policy),
      doubts_(instrument.axis.direction.x()),
      slide_(instrument.motion.max_speed, instrument.motion.max_acceleration) {
  MarkerTracker::lose(LostReason::NoFrame);
}

const Measurement& MarkerTracker::lose(LostReason reason) {
  constexpr double kNotSeen = std::numeric_limits<double>::quiet_NaN();
  measurement_ = {};
  measurement_.reason = reason;
  measurement_.slide = measurement_.rotation = measurement_.along = measurement_.lateral = kNotSeen;
  measurement_.pixel.setConstant(kNotSeen);
  return measurement_;
}

void MarkerTracker::reset() {
  slide_.reset();
  doubts_.reset();
  reach_.settle();
  lose(LostReason::NoFrame);
}

void MarkerTracker::stateDoubts(const MotionFilter::State& state, double scale, int height) {
  const Doubt doubt = doubts_.doubt();
  // by the speed, and by what is not known of it, as after the motion was broken off
  const double speed = std::sqrt(square(state.mean[1]) + state.covariance(1, 1));
  measurement_.along_variance += square(doubts_.shutterError(speed * scale, height));
  measurement_.covariance(0, 0) = measurement_.along_variance / square(scale);
  const double fastest = std::abs(state.mean[1]) + std::sqrt(state.covariance(1, 1));
  const bool known = doubts_.unknownShutterError(fastest, height) < policy_.unchecked_shift;
  measurement_.doubt = known || doubt == Doubt::Shutter ? doubt : Doubt::Unchecked;
}

}  // namespace vibe::vision
