#include "vibe_hardware/emulator/emulated_encoder.hpp"

#include <algorithm>

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

}  // namespace vibe::hardware
