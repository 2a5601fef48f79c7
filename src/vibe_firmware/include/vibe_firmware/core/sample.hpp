#pragma once
#include <array>
#include <cstdint>

#include "vibe_firmware/core/encoder.hpp"

namespace vibe_firmware {

/// What the board has read at the beginning of a tick.
struct HapticSample {
  std::array<std::uint32_t, kAxisCount> counter{};        ///< hardware counters; wrap after `counter_bits`
  std::array<bool, kAxisCount> index{};                   ///< whether the index pulse came since the last tick
  std::array<std::uint32_t, kAxisCount> index_counter{};  ///< hardware counter at that pulse
  std::uint16_t buttons = 0;                              ///< raw, one bit each
  bool drive_fault = false;                               ///< the power stage of the motors has switched off
  std::uint32_t time_us = 0;                              ///< free-running

  EncoderSample encoder(std::size_t axis) const { return {counter[axis], index[axis], index_counter[axis]}; }
};

}  // namespace vibe_firmware
