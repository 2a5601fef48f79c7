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

void EmulatedHaptic::restart() {
  FirmwareDevice::restart();
  torques_ = {};
}

void EmulatedHaptic::tick(const DeviceMotion& motion) {
  std::array<std::int32_t, kAxisCount> counts;
  for (std::size_t i = 0; i < kAxisCount; ++i)
    counts[i] = (config_.axes[i].radians_per_count < 0 ? -1 : 1) * encoderCount(plants_[i], axes_[i]);
  torques_ = firmware_->tick(sample(counts, motion.buttons));
  for (std::size_t i = 0; i < kAxisCount; ++i)
    step(plants_[i], static_cast<double>(torques_[i]), motion.intended[i], kTick, axes_[i]);
}

void EmulatedInput::tick(const DeviceMotion& motion) {
  std::array<std::int32_t, kAxisCount> counts;
  for (std::size_t i = 0; i < kAxisCount; ++i)
    counts[i] = static_cast<std::int32_t>(
        std::floor(motion.intended[i] / static_cast<double>(config_.axes[i].radians_per_count)));
  firmware_->tick(sample(counts, motion.buttons));
}

}  // namespace vibe::hardware
