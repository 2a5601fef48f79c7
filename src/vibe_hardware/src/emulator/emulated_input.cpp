#include "vibe_hardware/emulator/emulated_input.hpp"

#include <cmath>

namespace vibe::hardware {

EmulatedInput::EmulatedInput(const vibe_firmware::InputConfig& config, std::string serial)
    : config_(config), serial_(std::move(serial)) {
  for (const vibe_firmware::AxisConfig& axis : config.axes)
    encoders_.emplace_back(static_cast<std::int32_t>(std::lround(axis.counts_per_turn)), config.counter_bits);
  restart();
}

void EmulatedInput::restart() {
  firmware_ = std::make_unique<vibe_firmware::InputFunction>(config_, serial_.c_str());
  ticks_ = 0;
}

void EmulatedInput::tick(const DeviceMotion& motion) {
  vibe_firmware::HapticSample sample;
  for (std::size_t i = 0; i < encoders_.size(); ++i) {
    const auto step = static_cast<double>(config_.axes[i].radians_per_count);
    const vibe_firmware::EncoderSample read =
        encoders_[i].sample(static_cast<std::int32_t>(std::floor(motion.intended[i] / step)));
    sample.counter[i] = read.counter;
    sample.index[i] = read.index;
    sample.index_counter[i] = read.index_counter;
  }
  sample.buttons = motion.buttons;
  sample.time_us = 1000 * ticks_++;
  firmware_->tick(sample);
}

bool EmulatedInput::nextReport(std::uint8_t (&bytes)[vibe_firmware::kInputReportSize]) {
  return firmware_->nextReport(bytes);
}

}  // namespace vibe::hardware
