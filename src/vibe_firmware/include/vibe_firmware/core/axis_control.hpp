#pragma once
#include "vibe_firmware/core/axis.hpp"

namespace vibe_firmware {

/// Everything that changes in one axis.
struct AxisState {
  std::int32_t count = 0;     ///< unwrapped encoder count
  std::uint32_t counter = 0;  ///< hardware counter that belongs to `count`
  float position = 0;         ///< [rad]
  float velocity = 0;         ///< filtered [rad/s]
  float torque = 0;           ///< commanded in the last tick [N m]
  float energy = 0;           ///< that the axis may still give to the hand: see PassivityController [J]
};

/// Torque of the spring-damper at the present position and velocity, limited to the parameters' torque limit [N m].
float springDamperTorque(const AxisParameters& parameters, float position, float velocity);

}  // namespace vibe_firmware
