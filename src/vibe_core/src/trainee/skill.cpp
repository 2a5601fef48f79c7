#include "vibe_core/trainee/skill.hpp"

#include <cmath>

namespace vibe {

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
  skill.pace = mix(first.pace, second.pace);
  skill.look_time = mix(first.look_time, second.look_time);
  skill.foresight = mix(first.foresight, second.foresight);
  skill.reaction_time = mix(first.reaction_time, second.reaction_time);
  skill.aim_error = mix(first.aim_error, second.aim_error);
  skill.force_limit = mix(first.force_limit, second.force_limit);
  skill.turns = mix(first.turns, second.turns);
  skill.drawn = mix(first.drawn, second.drawn);
  skill.attempts = static_cast<int>(std::lround(mix(first.attempts, second.attempts)));
  skill.tightness = mix(first.tightness, second.tightness);
  skill.tremor.scale = mix(first.tremor.scale, second.tremor.scale);
  return skill;
}

}  // namespace vibe
