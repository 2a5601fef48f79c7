#include "vibe_core/metrics/skill_phases.hpp"

#include <algorithm>
#include <cmath>

#include "vibe_core/program/error.hpp"

namespace vibe {

ForceRecorder::ForceRecorder(const ForceSettings& settings) : settings_(settings) {
  if (!(settings.threshold >= 0 && settings.noise >= 0 && std::isfinite(settings.threshold + settings.noise)))
    throw Error("A ForceRecorder needs a threshold and a noise of 0 N or more; correct its settings.");
}

void ForceRecorder::add(double magnitude, double dt) {
  if (!(magnitude >= 0) || !(dt > 0) || !std::isfinite(magnitude + dt))
    throw Error("A ForceRecorder was given a force or a step that is not a finite number; leave such steps out.");
  sums_.time += dt;
  sums_.impulse += magnitude * dt;
  sums_.max = std::max(sums_.max, magnitude);
  if (magnitude > settings_.threshold) sums_.time_above += dt;
  if (magnitude > settings_.noise) {
    sums_.loaded_time += dt;
    loaded_impulse_ += magnitude * dt;
  }
}

ForceMeasures ForceRecorder::measures() const {
  ForceMeasures m = sums_;
  if (m.loaded_time > 0) m.mean = loaded_impulse_ / m.loaded_time;
  if (m.time > 0) m.share_above = m.time_above / m.time;
  return m;
}

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
