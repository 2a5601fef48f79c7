#pragma once
#include <array>
#include <cstdint>

#include "vibe_firmware/core/sample.hpp"
#include "vibe_firmware/protocol/reports.hpp"

// The input device: two encoders and buttons, no motors. Same samples and same report as the haptic device; torque 0.

namespace vibe_firmware {

/// Constant description of an input device. Of an axis, only what concerns the encoder is used: sample_period,
/// radians_per_count, full_scale, speed_limit, counts_per_turn.
struct InputConfig {
  std::array<AxisConfig, kAxisCount> axes{};  ///< hardware of each encoder
  std::uint32_t report_ticks = 10;            ///< between two input reports
  std::uint8_t counter_bits = 16;             ///< of the hardware counters, 1 to 32
  std::uint8_t debounce_ticks = 5;            ///< for which a button must be still
};

/// Everything that changes.
struct InputState {
  std::array<EncoderState, kAxisCount> encoders{};  ///< positions
  DebouncerState buttons{};                         ///< debounced
  std::uint16_t sequence = 0;                       ///< of the next input report
  std::uint32_t time_us = 0;                        ///< of the last tick, on the clock of the board; wraps [us]
  std::uint8_t flags = 0;                           ///< DeviceFlag bits
};

/// One tick of the 1 kHz sampling.
void step(const InputConfig& config, const HapticSample& sample, InputState& state);

/// The next input report; advances the sequence number.
InputReport takeReport(const InputConfig& config, InputState& state);

}  // namespace vibe_firmware
