#include "vibe_firmware/core/debouncer.hpp"

#include <cstddef>

namespace vibe_firmware {

void step(std::uint8_t ticks, std::uint16_t contacts, DebouncerState& state) {
  const auto changed = static_cast<std::uint16_t>(contacts ^ state.buttons);
  for (std::size_t i = 0; i < kButtonCount; ++i) {
    if ((changed >> i & 1) == 0) {
      state.differs[i] = 0;
    } else if (++state.differs[i] >= ticks) {
      state.buttons = static_cast<std::uint16_t>(state.buttons ^ (1U << i));
      state.differs[i] = 0;
    }
  }
}

}  // namespace vibe_firmware
