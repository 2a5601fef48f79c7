#include "vibe_hardware/emulator/emulated_device.hpp"

#include <algorithm>
#include <cmath>

namespace vibe::hardware {

std::int32_t EmulatedEncoder::turnOf(std::int32_t count) const {
  const std::int32_t from_index = count - kIndexCount, turn = from_index / counts_per_turn_;
  return from_index < turn * counts_per_turn_ ? turn - 1 : turn;  // rounded down
}

vibe_firmware::EncoderSample EmulatedEncoder::sample(std::int32_t count) {
  vibe_firmware::EncoderSample sample;
  sample.counter = static_cast<std::uint32_t>(count) & mask_;
  if (counts_per_turn_ > 0) {
    const std::int32_t before = turnOf(last_), now = turnOf(count);
    sample.index = before != now;
    // the timer latches the last pulse on the way
    const std::int32_t pulse = kIndexCount + counts_per_turn_ * (now > before ? now : now + 1);
    sample.index_counter = sample.index ? static_cast<std::uint32_t>(pulse) & mask_ : 0;
  }
  last_ = count;
  return sample;
}

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
