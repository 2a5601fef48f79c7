#include "vibe_vision/calibrate/calibration_check.hpp"

#include <algorithm>
#include <cmath>

#include "calibrate/fitting.hpp"
#include "calibrate/instrument_check.hpp"

namespace vibe::vision {
namespace {

// Within which a check looks for a marker; design choices.
constexpr double kWideLateral = 2e-3;  // [m]
constexpr double kWideScale = 0.3;
constexpr double kAlike = 3;  // standard deviations
constexpr double kFocalLimit = 0.03;

std::string percent(double share) {
  return withDecimals(100 * share, 1) + " %";
}

/// A camera that has moved shows in all instruments alike.
void nameTheCamera(const std::string& quantity, const std::string& sentence, std::vector<CheckedInstrument>& all) {
  std::vector<CheckedQuantity*> wrong;
  for (CheckedInstrument& instrument : all)
    for (CheckedQuantity& q : instrument.quantities)
      if (q.name == quantity && q.verdict == Verdict::Wrong) wrong.push_back(&q);
  if (all.size() < 2 || wrong.size() != all.size()) return;
  for (const CheckedQuantity* q : wrong)
    if (std::abs(q->value - wrong[0]->value) > std::max(q->limit, kAlike * q->deviation)) return;
  for (CheckedQuantity* q : wrong) q->text += "; all instruments are off alike: " + sentence;
}

/// All instruments together: a wrong focal length shows where the lens bends something, and does harm wherever a camera
/// moves. What none of them shows is no proof.
void judgeFocalLength(const std::vector<InstrumentCheck>& instruments, std::vector<CheckedInstrument>& all) {
  double information = 0, sum = 0;
  bool moved = false;
  for (const InstrumentCheck& instrument : instruments) {
    const auto [error, deviation] = instrument.focalError();
    if (!std::isfinite(deviation)) continue;
    moved = true;
    information += 1 / (deviation * deviation), sum += error / (deviation * deviation);
  }
  if (!moved) return;  // which is said of each quantity
  const double error = sum / information, deviation = 1 / std::sqrt(information);
  const bool shown = kAlike * deviation < kFocalLimit, wrong = shown && std::abs(error) > kFocalLimit;
  std::vector<CheckedQuantity*> lenses;
  for (CheckedInstrument& instrument : all)
    for (CheckedQuantity& q : instrument.quantities)
      if (q.name == "lens") lenses.push_back(&q);
  const auto is = [](Verdict verdict) { return [verdict](const CheckedQuantity* q) { return q->verdict == verdict; }; };
  const auto holds = std::find_if(lenses.begin(), lenses.end(), is(Verdict::Holds));
  if (std::any_of(lenses.begin(), lenses.end(), is(Verdict::Wrong)) || holds == lenses.end() || (shown && !wrong))
    return;
  CheckedQuantity& q = **holds;
  q.verdict = wrong ? Verdict::Wrong : Verdict::Unknown;
  q.text += wrong ? "; the focal length is too " + std::string(error > 0 ? "long" : "short") + " by about " +
                        percent(std::abs(error)) + ": calibrate the lens"
                  : "; this lens and motion would not show a focal length that is " + percent(kFocalLimit) +
                        " wrong: calibrate the lens with a board that is tilted to all sides";
}

VisionConfig widened(VisionConfig config) {
  config.gates.max_scale_error = std::max(config.gates.max_scale_error, kWideScale);
  for (InstrumentConfig& instrument : config.instruments)
    instrument.lateral_tolerance = std::max(instrument.lateral_tolerance, kWideLateral);
  return config;
}

}  // namespace

struct CalibrationCheck::Impl {
  explicit Impl(const VisionConfig& config) : following(widened(config)), alone(widened(config)) {
    for (const InstrumentConfig& instrument : config.instruments) instruments.emplace_back(instrument, config.camera);
  }

  Tracker following, alone;
  std::vector<InstrumentCheck> instruments;
};

CalibrationCheck::CalibrationCheck(const VisionConfig& config) : impl_(std::make_unique<Impl>(config)) {}
CalibrationCheck::~CalibrationCheck() = default;

void CalibrationCheck::add(const Frame& frame) {
  const Measurements& followed = impl_->following.track(frame);
  bool tells = false;
  for (std::size_t i = 0; i < followed.size(); ++i) {
    impl_->instruments[i].follow(followed[i], frame.stamp);
    tells |= impl_->instruments[i].isNew(followed[i]);
  }
  if (!tells) return;
  impl_->alone.reset();
  const Measurements& alone = impl_->alone.track(frame);
  for (std::size_t i = 0; i < alone.size(); ++i)
    if (impl_->instruments[i].isNew(followed[i])) impl_->instruments[i].look(alone[i], followed[i].slide);
}

std::vector<CheckedInstrument> CalibrationCheck::result() const {
  std::vector<CheckedInstrument> all;
  for (const InstrumentCheck& instrument : impl_->instruments) all.push_back(instrument.result());
  judgeFocalLength(impl_->instruments, all);
  nameTheCamera("scale", "the camera is nearer or farther, or has another lens", all);
  nameTheCamera("direction", "the camera has turned about its line of sight", all);
  return all;
}

}  // namespace vibe::vision
