#include "vibe_vision/predict/frame_pipeline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vibe::vision {

namespace {

constexpr double kSetBack = 1;  // more than this is a clock that was set, or a recording that begins again [s]
constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

CoordinateSample coordinateOf(const MotionEstimate& motion, bool valid) {
  CoordinateSample sample{kNoNumber, kNoNumber, kNoNumber, kNoNumber, {}};
  sample.covariance.fill(std::numeric_limits<float>::quiet_NaN());
  if (!valid) return sample;
  sample.position = motion.mean(0);
  sample.velocity = motion.mean(1);
  sample.acceleration = motion.mean(2);
  sample.jerk = motion.mean(3);
  std::size_t k = 0;
  for (int row = 0; row < 4; ++row)
    for (int column = row; column < 4; ++column)
      sample.covariance[k++] = static_cast<float>(motion.covariance(row, column));
  return sample;
}

constexpr double kLeastSlide = 1e-9, kLeastRotation = 1e-7;  // no measurement is better [m], [rad]

MotionEstimate updated(Predictor& predictor, double time, double value, double variance, double least) {
  predictor.update(time, value, std::max(variance, least * least));
  return predictor.predict(time);
}

}  // namespace

TrackDatagram makeDatagram(const Frame& frame, const Measurements& measurements,
                           const std::vector<JointSample>& samples) {
  static_assert(kSlidePrior.jerk.time == kRotationPrior.jerk.time, "a datagram has one correlation time");
  TrackDatagram datagram;
  datagram.exposure = static_cast<float>(frame.exposure);
  datagram.frame_sequence = frame.sequence;
  datagram.stamp = frame.stamp;
  datagram.jerk_time = static_cast<float>(kSlidePrior.jerk.time);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const JointSample& joint = samples[i];
    InstrumentSample sample;
    sample.tracked = joint.tracked();
    sample.reason = static_cast<std::uint8_t>(joint.reason);
    sample.has_rotation = joint.has_rotation;
    sample.score = joint.tracked() ? static_cast<float>(measurements[i].score) : 0;
    sample.slide = coordinateOf(joint.slide_motion, joint.tracked());
    sample.rotation = coordinateOf(joint.rotation_motion, joint.tracked() && joint.has_rotation);
    datagram.instruments.push_back(sample);
  }
  return datagram;
}

FramePipeline::FramePipeline(const VisionConfig& config, const Options& options) : options_(options), tracker_(config) {
  for (const InstrumentConfig& instrument : config.instruments) predictors_.emplace_back(instrument);
  if (!options.udp.empty()) sender_ = std::make_unique<UdpSender>(options.udp);
}

bool FramePipeline::isInOrder(double stamp) {
  if (std::isfinite(stamp) && stamp > last_stamp_) return true;
  if (std::isfinite(stamp) && stamp > 0 && stamp < last_stamp_ - kSetBack) {
    reset();
    return true;
  }
  ++disordered_;
  return false;
}

const FrameResult* FramePipeline::process(const Frame& frame) {
  if (!isInOrder(frame.stamp)) return nullptr;
  const double begin = options_.host_time();
  result_.frame = frame;
  result_.measurements = tracker_.track(frame);
  result_.tracked_at = options_.host_time();
  result_.samples.clear();
  for (std::size_t i = 0; i < predictors_.size(); ++i)
    result_.samples.push_back(predictors_[i].update(frame.stamp, result_.measurements[i]));
  result_.times = StageTimes();
  if (!options_.recorded) result_.times.transport = frame.arrival - frame.stamp;
  result_.times.wait = begin - frame.arrival;
  result_.times.track = result_.tracked_at - begin;
  last_stamp_ = last_frame_ = frame.stamp;
  last_frame_at_ = result_.tracked_at;
  send();
  return &result_;
}

const FrameResult& FramePipeline::reportSilence() {
  const double now = options_.host_time();
  // so far back that the next frame, whenever it comes, is later
  const double stamp = (last_frame_ > 0 ? last_frame_ + now - last_frame_at_ : now) - options_.silence / 2;
  const std::uint64_t sequence = result_.frame.sequence;
  result_ = FrameResult();
  result_.frame.sequence = sequence;
  result_.frame.stamp = std::max(stamp, last_stamp_ + 1e-6);
  result_.tracked_at = now;
  result_.measurements.resize(predictors_.size());  // NoFrame
  for (std::size_t i = 0; i < predictors_.size(); ++i)
    result_.samples.push_back(predictors_[i].update(result_.frame.stamp, result_.measurements[i]));
  last_stamp_ = result_.frame.stamp;
  send();
  return result_;
}

void FramePipeline::reset() {
  tracker_.reset();
  for (InstrumentPredictor& predictor : predictors_) predictor.reset();
}

void FramePipeline::send() {
  if (!sender_) return;
  TrackDatagram datagram = makeDatagram(result_.frame, result_.measurements, result_.samples);
  datagram.sequence = sequence_++;
  if (!options_.recorded) datagram.age = static_cast<float>(options_.host_time() - result_.frame.stamp);
  sender_->send(encode(datagram));
}

JointSample InstrumentPredictor::update(double time, const Measurement& measurement) {
  JointSample sample;
  sample.reason = measurement.reason;
  sample.has_rotation = !instrument_.rotation_joint.empty();
  sample.slide = sample.rotation = kNoNumber;
  if (!measurement.tracked()) return sample;
  sample.slide = instrument_.slide_sign * measurement.slide + instrument_.slide_offset;
  sample.variance[0] = instrument_.slide_sign * instrument_.slide_sign * measurement.covariance(0, 0);
  sample.slide_motion = updated(slide_, time, sample.slide, sample.variance[0], kLeastSlide);
  if (!sample.has_rotation) return sample;
  sample.rotation = instrument_.rotation_sign * measurement.rotation + instrument_.rotation_offset;
  sample.variance[1] = instrument_.rotation_sign * instrument_.rotation_sign * measurement.covariance(1, 1);
  sample.covariance = instrument_.slide_sign * instrument_.rotation_sign * measurement.covariance(0, 1);
  sample.rotation_motion = updated(rotation_, time, sample.rotation, sample.variance[1], kLeastRotation);
  return sample;
}

}  // namespace vibe::vision
