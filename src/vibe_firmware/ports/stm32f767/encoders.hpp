#pragma once
#include "registers.hpp"
#include "vibe_firmware/core/sample.hpp"

// This port has never run on hardware.

namespace vibe_firmware::stm32 {

/// TIM3 and TIM4 count both edges of both channels (RM0410, TIM2 to TIM5, encoder interface mode) and capture the
/// counter at the rising edge of the index on channel 3. 16 bits.
void startEncoders();

/// Fills counters and index pulses.
void readEncoders(HapticSample& sample);

}  // namespace vibe_firmware::stm32
