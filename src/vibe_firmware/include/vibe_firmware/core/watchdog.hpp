#pragma once
#include <cstdint>

namespace vibe_firmware {

/// Switches the spring off when the host is silent.
struct Watchdog {
  std::uint32_t timeout_ticks = 200;  ///< without valid parameters, after which the spring fades
  std::uint32_t ramp_ticks = 50;      ///< of the fading

  /// Value of a counter that has just timed out completely: a device starts silent.
  constexpr std::uint32_t end() const { return timeout_ticks + ramp_ticks; }

  /// Ticks since the last valid parameters, one tick later. Stops counting at end().
  constexpr std::uint32_t next(std::uint32_t ticks) const { return ticks < end() ? ticks + 1 : end(); }

  constexpr bool silent(std::uint32_t ticks) const { return ticks >= timeout_ticks; }

  /// Factor of the spring: 1 up to `timeout_ticks`, then linearly to 0 within `ramp_ticks`.
  constexpr float springGain(std::uint32_t ticks) const {
    if (ticks >= end()) return 0.0F;
    if (ticks <= timeout_ticks) return 1.0F;
    return static_cast<float>(end() - ticks) / static_cast<float>(ramp_ticks);
  }
};

}  // namespace vibe_firmware
