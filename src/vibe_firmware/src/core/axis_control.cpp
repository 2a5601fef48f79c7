#include "vibe_firmware/core/axis_control.hpp"

#include <cmath>

#include "vibe_firmware/core/passivity.hpp"

namespace vibe_firmware {
namespace {

/// Position and velocity, and the energy that the last torque has moved.
/// @return what the index pulse has corrected in the position [rad]
float measure(const AxisConfig& config, int counter_bits, const EncoderSample& sample, AxisState& state) {
  const std::int32_t before = state.encoder.count;
  const std::int32_t moved = step(config, counter_bits, sample, state.encoder);
  const float motion = static_cast<float>(moved) * config.radians_per_count;
  observe(config, state.torque, motion, state.energy);
  state.position = static_cast<float>(state.encoder.count) * config.radians_per_count;
  state.velocity = filteredVelocity(config.velocity_pole, state.velocity, motion / config.sample_period);
  return static_cast<float>(state.encoder.count - before - moved) * config.radians_per_count;
}

/// The hand has not caused this change of the position: the spring torque fades over to it.
void takeOverCorrection(const AxisParameters& parameters, float correction, float spring_gain, AxisState& state) {
  const float before = springTorque(parameters, state.position - correction);
  state.transition += spring_gain * (before - springTorque(parameters, state.position));
}

/// Lets what the host and the watchdog have changed come into force at the slew limit.
/// @return most that this changes the torque in this tick [N m]
float fade(const AxisConfig& config, const AxisParameters& parameters, float spring_gain, AxisState& state) {
  const float slew = config.slew_limit * config.sample_period;
  const float transition = approach(state.transition, 0, slew);
  const float fallen = state.torque_limit - slew;
  const float torque_limit = parameters.torque_limit > fallen ? parameters.torque_limit : fallen;
  const float change = std::fabs(transition - state.transition) + std::fabs(torque_limit - state.torque_limit) +
                       std::fabs(spring_gain - state.spring_gain) * parameters.torque_limit;
  state.transition = transition;
  state.torque_limit = torque_limit;
  state.spring_gain = spring_gain;
  state.limited = transition != 0 || torque_limit > parameters.torque_limit;
  return change;
}

/// Cuts the torque, and sets the velocity filter back to what gives the torque that is left.
float limitedTorque(float spring, float damping, float limit, AxisState& state) {
  const float wanted = spring - damping * state.velocity;
  const float torque = clamp(wanted, limit);
  if (torque == wanted) return torque;
  state.limited = true;
  const float velocity = damping > 0 ? (spring - torque) / damping : state.velocity;
  if (std::fabs(velocity) < std::fabs(state.velocity)) state.velocity = velocity;
  return torque;
}

}  // namespace

AxisState initialAxisState(const AxisConfig& config) {
  AxisState state;
  state.energy.balance = config.energy_capacity;
  return state;
}

float springTorque(const AxisParameters& parameters, float position) {
  return clamp(parameters.torque - parameters.stiffness * (position - parameters.position), parameters.torque_limit);
}

float springDamperTorque(const AxisParameters& parameters, float position, float velocity) {
  return clamp(springTorque(parameters, position) - parameters.damping * velocity, parameters.torque_limit);
}

float step(const AxisConfig& config, const AxisParameters& parameters, float spring_gain, int counter_bits,
           const EncoderSample& sample, AxisState& state) {
  const float correction = measure(config, counter_bits, sample, state);
  if (correction != 0) takeOverCorrection(parameters, correction, spring_gain, state);
  const float faded = fade(config, parameters, spring_gain, state);
  if (state.encoder.fault) {
    switchOff(state);
    return 0;
  }
  const float law = springTorque(parameters, state.position);
  if (parameters.torque_limit > 0 && std::fabs(law) >= parameters.torque_limit) state.limited = true;
  const float spring = spring_gain * law + state.transition;
  const PassivityLimit allowed = limit(config, spring, parameters.damping, state.torque_limit, state.energy);
  const float torque = limitedTorque(allowed.spring, allowed.damping, allowed.torque, state);
  const float change = std::fabs(torque - state.torque);
  const bool law_only = !allowed.acts && !state.passivity_acts;
  observeChange(config, law_only && faded < change ? faded : change, state.energy);
  state.passivity_acts = allowed.acts;
  state.torque = torque;
  return torque;
}

void takeOver(const AxisParameters& before, const AxisParameters& after, AxisState& state) {
  const float spring = state.spring_gain * springTorque(before, state.position);
  const float damping = before.damping * state.velocity;
  state.transition += (spring - damping) - (springTorque(after, state.position) - after.damping * state.velocity);
  state.spring_gain = 1;
  if (after.torque_limit > state.torque_limit) state.torque_limit = after.torque_limit;
}

void switchOff(AxisState& state) {
  state.torque = 0;
  state.transition = 0;
  state.passivity_acts = state.limited = false;
}

}  // namespace vibe_firmware
