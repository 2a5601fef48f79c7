#include "vibe_hardware/emulator/emulated_haptic.hpp"

#include <cmath>

namespace vibe::hardware {

using vibe_firmware::kAxisCount;

EmulatedHaptic::EmulatedHaptic(const vibe_firmware::HapticConfig& config, const Plants& plants, std::string serial)
    : config_(config), plants_(plants), serial_(std::move(serial)) {
  for (const vibe_firmware::AxisConfig& axis : config.axes)
    encoders_.emplace_back(static_cast<std::int32_t>(std::lround(axis.counts_per_turn)), config.counter_bits);
  restart();
}

void EmulatedHaptic::restart() {
  firmware_ = std::make_unique<vibe_firmware::HapticFunction>(config_, serial_.c_str());
  torques_ = {};
  ticks_ = 0;
}

void EmulatedHaptic::tick(const DeviceMotion& motion) {
  vibe_firmware::HapticSample sample;
  for (std::size_t i = 0; i < kAxisCount; ++i) {
    const std::int32_t direction = config_.axes[i].radians_per_count < 0 ? -1 : 1;
    const vibe_firmware::EncoderSample read = encoders_[i].sample(direction * encoderCount(plants_[i], axes_[i]));
    sample.counter[i] = read.counter;
    sample.index[i] = read.index;
    sample.index_counter[i] = read.index_counter;
  }
  sample.buttons = motion.buttons;
  sample.time_us = 1000 * ticks_++;
  torques_ = firmware_->tick(sample);
  for (std::size_t i = 0; i < kAxisCount; ++i)
    step(plants_[i], static_cast<double>(torques_[i]), motion.intended[i], kTick, axes_[i]);
}

bool EmulatedHaptic::nextReport(std::uint8_t (&bytes)[vibe_firmware::kInputReportSize]) {
  return firmware_->nextReport(bytes);
}

}  // namespace vibe::hardware
