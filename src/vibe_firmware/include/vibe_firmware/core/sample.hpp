#pragma once

#include <array>
#include <cstdint>

#include "vibe_firmware/core/axis.hpp"

namespace vibe_firmware {

/// What the board has read of one encoder at the beginning of a tick.
struct EncoderSample {
  std::uint32_t counter = 0;        ///< hardware counter; wraps
  bool index = false;               ///< whether the index pulse came since the last tick
  std::uint32_t index_counter = 0;  ///< the counter at that pulse
};

/// Position of a hardware counter that wraps.
struct EncoderState {
  std::int32_t count = 0;        ///< unwrapped since the start; 0 there
  std::uint32_t counter = 0;     ///< hardware counter that belongs to `count`
  std::int32_t index_count = 0;  ///< count of the first index pulse
  bool started = false;          ///< a sample has been taken
  bool indexed = false;          ///< an index pulse has been seen; `index_count` is valid
  bool fault = false;            ///< stays until the device is started again
};

/// Takes one sample. The first one defines count 0. The index pulse corrects counts that were lost or gained since the
/// first one: a difference of one count is within the width of the pulse and ignored, up to an eighth of a turn is
/// corrected, more is a fault. So are a motion faster than AxisConfig::speed_limit, which is not counted, and a count
/// beyond kMaxCount.
/// @param counter_bits  after which the counter wraps, 1 to 32
/// @return counts by which the axis has moved since the last tick, correction not included
std::int32_t step(const AxisConfig& config, int counter_bits, const EncoderSample& sample, EncoderState& state);

constexpr int kButtonCount = 16;  ///< bits of a report and of the contacts of a board

/// Buttons whose contacts bounce: a button changes when its contact has been in the other position for some ticks
/// without interruption.
struct DebouncerState {
  std::uint16_t buttons = 0;                         ///< debounced, one bit each
  std::array<std::uint8_t, kButtonCount> differs{};  ///< ticks for which the contact has been in the other position
};

/// @param ticks  after which a button changes; 0 and 1: at once
void step(std::uint8_t ticks, std::uint16_t contacts, DebouncerState& state);

/// What the board has read at the beginning of a tick.
struct HapticSample {
  std::array<std::uint32_t, kAxisCount> counter{};        ///< hardware counters; wrap after `counter_bits`
  std::array<bool, kAxisCount> index{};                   ///< whether the index pulse came since the last tick
  std::array<std::uint32_t, kAxisCount> index_counter{};  ///< hardware counter at that pulse
  std::uint16_t buttons = 0;                              ///< raw, one bit each
  bool drive_fault = false;                               ///< the power stage of the motors has switched off
  std::uint32_t time_us = 0;                              ///< free-running

  /// What a sample says of one axis, 0 or 1.
  EncoderSample encoder(std::size_t axis) const { return {counter[axis], index[axis], index_counter[axis]}; }
};

}  // namespace vibe_firmware
