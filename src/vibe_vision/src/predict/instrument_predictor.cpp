#include "vibe_vision/predict/instrument_predictor.hpp"

#include <algorithm>
#include <limits>

namespace vibe::vision {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kLeastSlide = 1e-9, kLeastRotation = 1e-7;  // no measurement is better [m], [rad]

MotionEstimate updated(Predictor& predictor, double time, double value, double variance, double least) {
  predictor.update(time, value, std::max(variance, least * least));
  return predictor.predict(time);
}

}  // namespace

InstrumentPredictor::InstrumentPredictor(const InstrumentConfig& instrument)
    : slide_sign_(instrument.slide_sign),
      slide_offset_(instrument.slide_offset),
      rotation_sign_(instrument.rotation_sign),
      rotation_offset_(instrument.rotation_offset),
      has_rotation_(!instrument.rotation_joint.empty()) {}

JointSample InstrumentPredictor::update(double time, const Measurement& measurement) {
  JointSample sample;
  sample.reason = measurement.reason;
  sample.has_rotation = has_rotation_;
  sample.slide = sample.rotation = kNaN;
  if (!measurement.tracked()) return sample;
  sample.slide = slide_sign_ * measurement.slide + slide_offset_;
  sample.variance[0] = slide_sign_ * slide_sign_ * measurement.covariance(0, 0);
  sample.slide_motion = updated(slide_, time, sample.slide, sample.variance[0], kLeastSlide);
  if (!has_rotation_) return sample;
  sample.rotation = rotation_sign_ * measurement.rotation + rotation_offset_;
  sample.variance[1] = rotation_sign_ * rotation_sign_ * measurement.covariance(1, 1);
  sample.covariance = slide_sign_ * rotation_sign_ * measurement.covariance(0, 1);
  sample.rotation_motion = updated(rotation_, time, sample.rotation, sample.variance[1], kLeastRotation);
  return sample;
}

void InstrumentPredictor::reset() {
  slide_.reset();
  rotation_.reset();
}

}  // namespace vibe::vision
