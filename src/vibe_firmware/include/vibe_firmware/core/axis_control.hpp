#pragma once

#include "vibe_firmware/core/axis.hpp"
#include "vibe_firmware/core/passivity.hpp"
#include "vibe_firmware/core/sample.hpp"

namespace vibe_firmware {

/// `value` moved towards `target` by at most `step`.
constexpr float approach(float value, float target, float step) {
  if (value < target - step) return value + step;
  if (value > target + step) return value - step;
  return target;
}

/// `value` limited to [-limit, limit]. @param limit  at least 0
constexpr float clamp(float value, float limit) {
  if (value > limit) return limit;
  if (value < -limit) return -limit;
  return value;
}

/// One step of the low-pass filter v = a v + (1 - a) dx/T. Its gain at rest is 1, its time constant T / -ln a.
/// @param pole  a, in [0, 1)
/// @param speed  dx/T [rad/s]
constexpr float filteredVelocity(float pole, float velocity, float speed) {
  return pole * velocity + (1.0F - pole) * speed;
}

/// Everything that changes in one axis.
struct AxisState {
  EncoderState encoder{};       ///< counts since the start of the device
  float position = 0;           ///< [rad]
  float velocity = 0;           ///< filtered [rad/s]
  float torque = 0;             ///< commanded in the last tick [N m]
  float spring_gain = 0;        ///< of the last tick, from 0 (host silent) to 1 (ratio)
  float transition = 0;         ///< torque added to the spring so that new parameters do not jump; fades [N m]
  float torque_limit = 0;       ///< in force; falls at the slew limit to that of the parameters [N m]
  EnergyAccount energy{};       ///< that the axis may still give to the hand
  bool limited = false;         ///< torque or slew limit acts
  bool passivity_acts = false;  ///< spring or torque limit were lowered in the last tick: the energy runs low
};

/// At rest at count 0, with a full account of energy and a torque limit of 0 until parameters come.
AxisState initialAxisState(const AxisConfig& config);

/// Torque of the spring alone, limited to the parameters' torque limit [N m].
float springTorque(const AxisParameters& parameters, float position);

/// Torque of the spring-damper at the present position and velocity, limited to the parameters' torque limit [N m]. The
/// spring is limited first, then the sum.
float springDamperTorque(const AxisParameters& parameters, float position, float velocity);

/// One tick of an axis.
///
/// The torque limit acts on the velocity filter too: where it cuts the torque, the filter is set back to the velocity
/// that gives the limited torque. So the filter never stores more than the linear law that the passivity conditions are
/// about. The slew limit does not delay the response to the hand, which would need more friction, only what the host
/// and the watchdog change.
///
/// @param spring_gain  from the watchdog
/// @return torque of the motor, until the next tick [N m]
float step(const AxisConfig& config, const AxisParameters& parameters, float spring_gain, int counter_bits,
           const EncoderSample& sample, AxisState& state);

/// Replaces the parameters between two ticks without a jump of the torque.
void takeOver(const AxisParameters& before, const AxisParameters& after, AxisState& state);

/// Torque 0 at once, as after an encoder fault.
void switchOff(AxisState& state);

}  // namespace vibe_firmware
