#pragma once
#include <array>
#include <cstdint>

namespace vibe_firmware {

constexpr int kButtonCount = 16;

/// Buttons whose contacts bounce: a button changes when its contact has been in the other position for some ticks
/// without interruption.
struct DebouncerState {
  std::uint16_t buttons = 0;                         ///< debounced, one bit each
  std::array<std::uint8_t, kButtonCount> differs{};  ///< ticks for which the contact has been in the other position
};

/// @param ticks  after which a button changes; 0 and 1: at once
void step(std::uint8_t ticks, std::uint16_t contacts, DebouncerState& state);

}  // namespace vibe_firmware
