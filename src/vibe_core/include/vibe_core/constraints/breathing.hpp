#pragma once

#include <Eigen/Core>

#include "vibe_core/scene/scene.hpp"

namespace vibe {

/// How far the diaphragm has moved the foundation and the entry from where they are at rest, in world [m]: towards the
/// feet (-z) by half the amplitude times 1 - cos(2 pi rate time). So time 0 is the end of an expiration, without a jump
/// of position or velocity. It is a function of the time alone: nothing of it is stored in State.
/// @param time  simulated [s]
Eigen::Vector3d breathingShift(const BreathingScene& breathing, double time);

/// Its rate of change [m/s].
Eigen::Vector3d breathingSpeed(const BreathingScene& breathing, double time);

}  // namespace vibe
