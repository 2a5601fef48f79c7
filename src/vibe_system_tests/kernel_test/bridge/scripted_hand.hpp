#pragma once
#include <cstdint>

#include "vibe_firmware/core/haptic_device.hpp"

namespace vibe::hardware {

/// What the encoders and buttons of a device read while a hand turns axis 0 steadily there and back, swings axis 1 and
/// presses one button after the other, each for a quarter of a second. A function of the tick alone.
/// @param tick  of the 1 kHz loop, from 0
vibe_firmware::HapticSample scriptedHand(std::uint32_t tick);

}  // namespace vibe::hardware
