#include "vibe_firmware/core/input_device.hpp"

#include "core/sample_report.hpp"

namespace vibe_firmware {

void step(const InputConfig& config, const HapticSample& sample, InputState& state) {
  state.flags = 0;
  for (std::size_t i = 0; i < kAxisCount; ++i) {
    step(config.axes[i], config.counter_bits, sample.encoder(i), state.encoders[i]);
    state.flags = static_cast<std::uint8_t>(state.flags | encoderFlags(state.encoders[i], i));
  }
  step(config.debounce_ticks, sample.buttons, state.buttons);
  state.time_us = sample.time_us;
}

InputReport takeReport(const InputConfig& config, InputState& state) {
  InputReport report;
  for (std::size_t i = 0; i < kAxisCount; ++i) reportEncoder(config.axes[i], state.encoders[i], i, report);
  report.buttons = state.buttons.buttons;
  report.sequence = state.sequence++;
  report.time_us = state.time_us;
  report.flags = state.flags;
  return report;
}

}  // namespace vibe_firmware
