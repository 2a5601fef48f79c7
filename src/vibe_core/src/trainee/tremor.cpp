#include "vibe_core/trainee/tremor.hpp"

#include <cmath>

#include "common/elementary.hpp"
#include "vibe_core/common/random.hpp"

namespace vibe {
namespace {

constexpr double kTwoPi = 6.28318530717958647692;
constexpr int kWaveCount = 6;  // enough that the sum does not look periodic within a session

}  // namespace

Tremor::Tremor(const TremorSettings& settings, std::uint64_t seed) {
  const double band = settings.high_frequency - settings.low_frequency;
  std::uint64_t random = seed;
  for (int joint = 0; joint < kJointCount; ++joint) {
    // A sinusoid of amplitude a has the root mean square a / sqrt(2); the squares of independent ones add up.
    const double amplitude = settings.scale * settings.amplitude[joint] * std::sqrt(2.0 / kWaveCount);
    for (int k = 0; k < kWaveCount; ++k) {
      // One frequency in each equal part of the band, so that no seed leaves the band or clusters its frequencies.
      // Drawn for joints without tremor too, so that adding a tremor to one joint does not change another's.
      const double frequency = settings.low_frequency + band * (k + nextUniform(random)) / kWaveCount;
      const double phase = kTwoPi * nextUniform(random);
      if (amplitude > 0) waves_[joint].push_back({kTwoPi * frequency, phase, amplitude});
    }
  }
}

double Tremor::at(int joint, double time) const {
  double sum = 0;
  for (const Wave& wave : waves_[joint]) sum += wave.amplitude * math::sin(wave.angular_frequency * time + wave.phase);
  return sum;
}

}  // namespace vibe
