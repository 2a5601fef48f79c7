#pragma once
#include <array>
#include <cstdint>

#include "vibe_firmware/core/axis_control.hpp"
#include "vibe_firmware/protocol/reports.hpp"

namespace vibe_firmware {

/// Constant description of a haptic device.
struct HapticConfig {
  std::array<AxisConfig, kAxisCount> axes{};
  std::uint32_t host_timeout_ticks = 200;  ///< without valid parameters: the torque ramps to zero
  std::uint32_t ramp_ticks = 50;           ///< of that ramp
  std::uint8_t counter_bits = 16;          ///< of the hardware counters, 1 to 32
};

/// What the board has read at the beginning of a tick.
struct HapticSample {
  std::array<std::uint32_t, kAxisCount> counter{};  ///< hardware counters; wrap at HapticConfig::counter_bits
  std::array<bool, kAxisCount> index{};             ///< whether the index pulse came since the last tick
  std::uint16_t buttons = 0;                        ///< raw, one bit each
  std::uint32_t time_us = 0;                        ///< free-running
};

/// Everything that changes. A copy is a snapshot; equal states with equal inputs give equal bits on every machine.
struct HapticState {
  std::array<AxisState, kAxisCount> axes{};
  ParameterReport parameters{};  ///< in force
  StatusReport status{};
  std::uint32_t ticks_since_host = 0;
  std::uint16_t sequence = 0;
  std::uint16_t buttons = 0;  ///< debounced
  std::uint32_t time_us = 0;
};

HapticState initialState(const HapticConfig& config);

/// One tick of the 1 kHz loop. @return torque of each axis [N m], to be written to the motors in the same tick
std::array<float, kAxisCount> step(const HapticConfig& config, const HapticSample& sample, HapticState& state);

/// Takes over a set from the host if it is valid; otherwise keeps the old one and notes why. Either way nothing jumps:
/// the slew limit and the energy account of the axes still hold. @return the verdict
Verdict setParameters(const HapticConfig& config, const ParameterReport& parameters, HapticState& state);

/// The next input report; advances the sequence number.
InputReport takeReport(const HapticConfig& config, HapticState& state);

}  // namespace vibe_firmware
