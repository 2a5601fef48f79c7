#include "vibe_core/trainee/tremor.hpp"

#include <cmath>

namespace vibe {
namespace {

constexpr double kTwoPi = 6.28318530717958647692;
constexpr int kWaveCount = 6;  // enough that the sum does not look periodic within a session

/// SplitMix64 (Steele, Lea & Flood 2014): the same numbers on every machine, unlike std::uniform_real_distribution.
double nextUniform(std::uint64_t& state) {
  state += 0x9e3779b97f4a7c15ULL;
  std::uint64_t z = state;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  z ^= z >> 31;
  return static_cast<double>(z >> 11) * 0x1.0p-53;
}

}  // namespace

Tremor::Tremor(const TremorSettings& settings, std::uint64_t seed) {
  const double band = settings.high_frequency - settings.low_frequency;
  std::uint64_t random = seed;
  for (int joint = 0; joint < kJointCount; ++joint) {
    // A sinusoid of amplitude a has the root mean square a / sqrt(2); independent ones add in squares.
    const double amplitude = settings.scale * settings.amplitude[joint] * std::sqrt(2.0 / kWaveCount);
    for (int k = 0; k < kWaveCount; ++k) {
      // One frequency in each equal part of the band, so that a seed can neither leave it nor crowd one spot. Drawn
      // for silent joints too, so that giving one joint a tremor does not change another's.
      const double frequency = settings.low_frequency + band * (k + nextUniform(random)) / kWaveCount;
      const double phase = kTwoPi * nextUniform(random);
      if (amplitude > 0) waves_[joint].push_back({kTwoPi * frequency, phase, amplitude});
    }
  }
}

double Tremor::at(int joint, double time) const {
  double sum = 0;
  for (const Wave& wave : waves_[joint]) sum += wave.amplitude * std::sin(wave.angular_frequency * time + wave.phase);
  return sum;
}

}  // namespace vibe
