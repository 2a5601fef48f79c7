#pragma once

#include <array>
#include <cstdint>

#include "vibe_firmware/core/axis_control.hpp"
#include "vibe_firmware/core/sample.hpp"
#include "vibe_firmware/protocol/reports.hpp"

namespace vibe_firmware {

/// Switches the spring off when the host is silent.
struct Watchdog {
  std::uint32_t timeout_ticks = 200;  ///< without valid parameters, after which the spring fades
  std::uint32_t ramp_ticks = 50;      ///< of the fading

  /// Value of a counter that has just timed out completely: a device starts silent.
  constexpr std::uint32_t end() const { return timeout_ticks + ramp_ticks; }

  /// Ticks since the last valid parameters, one tick later. Stops counting at end().
  constexpr std::uint32_t next(std::uint32_t ticks) const { return ticks < end() ? ticks + 1 : end(); }

  /// No valid parameters have come for the timeout.
  constexpr bool silent(std::uint32_t ticks) const { return ticks >= timeout_ticks; }

  /// Factor of the spring: 1 up to `timeout_ticks`, then linearly to 0 within `ramp_ticks`.
  constexpr float springGain(std::uint32_t ticks) const {
    if (ticks >= end()) return 0.0F;
    if (ticks <= timeout_ticks) return 1.0F;
    return static_cast<float>(end() - ticks) / static_cast<float>(ramp_ticks);
  }
};

/// Constant description of a haptic device.
struct HapticConfig {
  std::array<AxisConfig, kAxisCount> axes{};  ///< hardware of each axis
  std::uint32_t host_timeout_ticks = 200;     ///< without valid parameters: the torque ramps to zero
  std::uint32_t ramp_ticks = 50;              ///< of that ramp
  std::uint32_t report_ticks = 10;            ///< between two input reports
  std::uint8_t counter_bits = 16;             ///< of the hardware counters, 1 to 32
  std::uint8_t debounce_ticks = 5;            ///< for which a button must be still

  Watchdog watchdog() const { return {host_timeout_ticks, ramp_ticks}; }  ///< of the host, with these times
};

/// Everything that changes. A copy is a snapshot; equal states with equal inputs give equal bits on every machine.
struct HapticState {
  std::array<AxisState, kAxisCount> axes{};  ///< motion, torque and energy of each axis
  ParameterReport parameters{};              ///< in force
  StatusReport status{};               ///< counters and verdicts of setParameters(); flags are those of the last tick
  std::uint32_t ticks_since_host = 0;  ///< since the last valid parameters; stops at Watchdog::end()
  std::uint16_t sequence = 0;          ///< of the next input report
  DebouncerState buttons{};            ///< debounced
  std::uint32_t time_us = 0;           ///< of the last tick, on the clock of the board; wraps [us]
};

/// At count 0, silent: without torque until the first valid parameters.
HapticState initialState(const HapticConfig& config);

/// One tick of the 1 kHz loop. @return torque of each axis [N m], to be written to the motors in the same tick
std::array<float, kAxisCount> step(const HapticConfig& config, const HapticSample& sample, HapticState& state);

/// Takes over a set from the host if it is valid; otherwise keeps the old one and notes why. Either way nothing jumps:
/// the slew limit and the energy account of the axes still hold. @return the verdict
Verdict setParameters(const HapticConfig& config, const ParameterReport& parameters, HapticState& state);

/// The two halves of setParameters(), for devices that check outside the control interrupt and apply in it.
/// judge() touches nothing but `status`; takeOver() expects parameters that have passed it.
Verdict judge(const HapticConfig& config, const ParameterReport& parameters, StatusReport& status);
/// Puts parameters in force and restarts the watchdog of the host.
void takeOver(const ParameterReport& parameters, HapticState& state);

/// The next input report; advances the sequence number.
InputReport takeReport(const HapticConfig& config, HapticState& state);

}  // namespace vibe_firmware
