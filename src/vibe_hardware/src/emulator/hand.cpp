#include "vibe_hardware/emulator/hand.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "vibe_core/arithmetic/random.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::hardware {

namespace {

/// In [0, 1), a function of its arguments only.
double uniform(std::uint64_t seed, std::uint64_t stream, std::uint64_t index) {
  return static_cast<double>(mixed(mixed(mixed(seed) ^ stream) ^ index) >> 11) * 0x1p-53;
}

constexpr double kPi = 3.14159265358979323846;
constexpr int kWaves = 6;
constexpr double kLowest = 0.05, kHighest = 0.5;  // [Hz]
constexpr double kStart = 2;                      // time to leave 0 [s]
constexpr double kSlot = 4;                       // a button is pressed at most once in each [s]

bool pressed(std::uint64_t seed, int button, double time) {
  const double slot = std::floor(time / kSlot);
  const auto index = static_cast<std::uint64_t>(slot) * 3;
  const auto stream = static_cast<std::uint64_t>(1000 + button);
  if (uniform(seed, stream, index) > 0.3) return false;
  const double length = 0.3 + 1.7 * uniform(seed, stream, index + 1);
  const double begin = slot * kSlot + (kSlot - length - 0.3) * uniform(seed, stream, index + 2);
  return time >= begin && time < begin + length;
}

/// From 0 to 1 in kStart, with a continuous speed.
double fadeIn(double time) {
  const double s = std::clamp(time / kStart, 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

}  // namespace

RandomHand::RandomHand(std::uint64_t seed, const std::array<RandomRange, kScopeJointCount>& ranges) : seed_(seed) {
  for (int joint = 0; joint < kScopeJointCount; ++joint) {
    const RandomRange& range = ranges[joint];
    middle_[joint] = 0.5 * (range.low + range.high);
    double reach = 0, speed = 0;
    for (std::uint64_t i = 0; i < kWaves; ++i) {
      const auto stream = static_cast<std::uint64_t>(joint);
      Wave wave;
      wave.frequency = 2 * kPi * (kLowest + (kHighest - kLowest) * uniform(seed, stream, 3 * i));
      wave.phase = 2 * kPi * uniform(seed, stream, 3 * i + 1);
      wave.amplitude = 0.2 + uniform(seed, stream, 3 * i + 2);
      reach += wave.amplitude;
      speed += wave.amplitude * wave.frequency;
      waves_[joint].push_back(wave);
    }
    const double scale = std::min(0.5 * (range.high - range.low) / reach, range.speed / speed);
    for (Wave& wave : waves_[joint]) wave.amplitude *= scale;
  }
}

HandSample RandomHand::at(double time) const {
  HandSample sample;
  for (int joint = 0; joint < kScopeJointCount; ++joint) {
    double position = middle_[joint];
    for (const Wave& wave : waves_[joint]) position += wave.amplitude * std::sin(wave.frequency * time + wave.phase);
    sample.joints[joint] = fadeIn(time) * position;
  }
  for (int button = 0; button < kButtonCount; ++button) sample.buttons[button] = pressed(seed_, button, time) ? 1 : 0;
  return sample;
}

double RandomHand::duration() const {
  return std::numeric_limits<double>::infinity();
}

HandSample ScriptedHand::at(double time) const {
  const StepInput input = script_.at(time);
  return {input.joints, input.buttons};
}

namespace {

constexpr double kAfter = 1;  // time the hand holds still after the last blink [s]

}  // namespace

BlinkHand::BlinkHand(const BlinkSetup& setup, std::shared_ptr<const Hand> other)
    : other_(std::move(other)), step_(setup.step) {
  if (other_ && !std::isfinite(other_->duration()))
    throw Error("A hand that blinks follows one that ends; give a script.");
  if (setup.count < 1 || !(setup.shortest > 0) || !(setup.longest >= setup.shortest))
    throw Error("A hand that blinks needs at least one blink, and a time between blinks above 0.");
  double time = (other_ ? other_->duration() : 0) + setup.begin;
  for (int i = 0; i < setup.count; ++i) {
    time += setup.shortest + (setup.longest - setup.shortest) * uniform(setup.seed, 0, static_cast<std::uint64_t>(i));
    blinks_.push_back(time);
  }
}

HandSample BlinkHand::at(double time) const {
  HandSample sample = other_ ? other_->at(time) : HandSample();
  const auto past = std::upper_bound(blinks_.begin(), blinks_.end(), time) - blinks_.begin();
  if (past % 2 == 1) sample.joints[TipLeftRight] += step_;
  return sample;
}

double BlinkHand::duration() const {
  return blinks_.back() + kAfter;
}

BlinkLog::BlinkLog(const std::string& file, std::vector<double> blinks)
    : file_(file), out_(file), blinks_(std::move(blinks)) {
  out_ << "blink,event,report\n" << std::flush;
  if (!out_)
    throw Error("The blinks cannot be written to '" + file_ +
                "'; choose a file that you may write, in a folder that exists.");
}

void BlinkLog::tick(double hand, std::int64_t wall) {
  for (; next_ < blinks_.size() && blinks_[next_] <= hand; ++next_)
    events_.push_back(wall - std::llround(1e9 * (hand - blinks_[next_])));
}

void BlinkLog::report(std::int64_t wall) {
  if (reported_ == events_.size()) return;
  for (; reported_ < events_.size(); ++reported_) out_ << reported_ << ',' << events_[reported_] << ',' << wall << '\n';
  out_.flush();
  if (!out_) throw Error("The blinks cannot be written to '" + file_ + "' any more; the disk may be full.");
}

}  // namespace vibe::hardware
