#pragma once

#include <Eigen/Core>
#include <string>

#include "vibe_core/scene/scene.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

/// How far the diaphragm has moved the foundation and the entry from where they are at rest, in world [m]: towards the
/// feet (-z) by half the amplitude times 1 - cos(angle), where the angle grows evenly by pi in an inspiration and in an
/// expiration. So time 0 is the end of an expiration, without a jump of position or velocity.
/// @param time  for which it has breathed, see breathingTime() [s]
Eigen::Vector3d breathingShift(const BreathingScene& breathing, double time);

/// Its rate of change [m/s].
Eigen::Vector3d breathingSpeed(const BreathingScene& breathing, double time);

/// Why no breath of a scene can be held, as a sentence; empty: it breathes.
std::string breathRefusal(const Scene& scene);

/// The time of a state without that in which the breath was held [s].
inline double breathingTime(const State& state) {
  return state.time - state.motion.held_time;
}

/// Where the organ's own motions are, from 0 to 1; 0 where the scene has none.
struct OrganPhases {
  double breath = 0;  ///< part of a breath, which begins with the inspiration (ratio)
  double wave = 0;    ///< part of the period of contraction waves, which begin at mid corpus (ratio)
  double heart = 0;   ///< part of a beat (ratio)
};

/// Those of a state, from its time and from how long the breath was held.
OrganPhases organPhases(const Scene& scene, const State& state);

}  // namespace vibe
