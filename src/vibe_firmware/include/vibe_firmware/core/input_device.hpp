#pragma once
#include <array>
#include <cstdint>

#include "vibe_firmware/core/haptic_device.hpp"

// The input device: two encoders and buttons, no motors. Same samples and same report as the haptic device; torque 0.

namespace vibe_firmware {

/// Constant description of an input device. Only radians_per_count and full_scale of an axis are used.
struct InputConfig {
  std::array<AxisConfig, kAxisCount> axes{};
};

struct InputState {
  std::array<AxisState, kAxisCount> axes{};
  std::uint16_t buttons = 0;  ///< debounced
  std::uint16_t sequence = 0;
  std::uint32_t time_us = 0;
  std::uint8_t flags = 0;
};

/// One tick of the 1 kHz sampling.
void step(const InputConfig& config, const HapticSample& sample, InputState& state);

/// The next input report; advances the sequence number.
InputReport takeReport(const InputConfig& config, InputState& state);

}  // namespace vibe_firmware
