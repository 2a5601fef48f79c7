#include "vibe_hardware/emulator/random_hand.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "counter_random.hpp"

namespace vibe::hardware {
namespace {

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

}  // namespace vibe::hardware
