#include "vibe_core/trainee/skill.hpp"

#include <cmath>

#include "arithmetic/elementary.hpp"
#include "vibe_core/arithmetic/random.hpp"

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

Skill Skill::novice() {
  Skill skill;
  skill.name = "novice";
  skill.pace = 0.31;  // 31.5 s against 101.5 s for the same task (colonoscope hand motion, Holden)
  skill.look_time = 60;
  skill.foresight = 0;
  skill.reaction_time = 0.3;
  skill.aim_error = 4e-3;
  skill.force_limit = 8;  // largest tip force seen in transgastric surgery (Trejos 2011)
  skill.turns = 1.5;
  skill.drawn = 4e-3;
  skill.attempts = 3;
  skill.checks_depth = false;
  skill.tightness = 0.3;
  skill.tremor.scale = 4;
  return skill;
}

Skill between(const Skill& first, const Skill& second, double part) {
  const auto mix = [part](double a, double b) { return (1 - part) * a + part * b; };
  Skill skill = part < 0.5 ? first : second;
  skill.name = part <= 0 ? first.name : part >= 1 ? second.name : first.name + " to " + second.name;
  for (double Skill::*value : {&Skill::pace, &Skill::look_time, &Skill::foresight, &Skill::reaction_time,
                               &Skill::aim_error, &Skill::force_limit, &Skill::turns, &Skill::drawn, &Skill::tightness})
    skill.*value = mix(first.*value, second.*value);
  skill.attempts = static_cast<int>(std::lround(mix(first.attempts, second.attempts)));
  skill.tremor.scale = mix(first.tremor.scale, second.tremor.scale);
  return skill;
}

}  // namespace vibe
