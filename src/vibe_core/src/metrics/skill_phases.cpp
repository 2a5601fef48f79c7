#include "vibe_core/metrics/skill_phases.hpp"

#include <cmath>

namespace vibe {

PhaseRecorder::PhaseRecorder(const std::shared_ptr<SpectralArcLength>& spectrum) {
  channel_.reserve(kPhaseCount + 1);
  for (int k = 0; k <= kPhaseCount; ++k) channel_.push_back({MotionRecorder({}, spectrum), ForceRecorder()});
}

void PhaseRecorder::start(const Eigen::Vector3d& tip, double dt) {
  if (!tip.allFinite()) return;
  moves_ = true;
  last_tip_ = tip;
  channel_[kPhaseCount].motion.add(tip, dt);
}

// The phase's way begins where the last one's ended, so that no step's way is lost between them.
void PhaseRecorder::enter(int phase, double dt) {
  if (present_ >= 0) {
    channel_[present_].motion.finish();
    measures_.phase[present_].motion = channel_[present_].motion.measures();
  }
  channel_[phase].motion.add(last_tip_, dt);
  present_ = phase;
}

void PhaseRecorder::record(Phase phase, const Eigen::Vector3d& tip, double force, double dt) {
  const int k = static_cast<int>(phase);
  if (moves_ && k != present_) enter(k, dt);
  const bool moved = moves_ && tip.allFinite(), loaded = std::isfinite(force);
  for (int c : {k, kPhaseCount}) {
    PhaseSkill& skill = c == kPhaseCount ? measures_.whole : measures_.phase[c];
    skill.time += dt;
    if (moved) channel_[c].motion.add(tip, dt);
    if (loaded) channel_[c].force.add(force, dt);
    skill.motion = channel_[c].motion.measures();
    skill.force = channel_[c].force.measures();
  }
  if (moved) last_tip_ = tip;
}

}  // namespace vibe
