#pragma once
#include "registers.hpp"

// This port has never run on hardware.

namespace vibe_firmware::stm32 {

/// TIM5 counts microseconds, TIM6 interrupts at 1 kHz from the same clock, with the highest priority.
void startTiming();

inline std::uint32_t microseconds() {
  return tim5().cnt;
}

/// To be called in the interrupt; otherwise it comes again at once.
inline void acknowledgeTick() {
  tim6().sr = 0;
}

/// IWDG: resets the board 50 ms after the last feedWatchdog(). Its clock, 32 kHz, is an RC oscillator: the
/// data sheet allows 17 kHz to 47 kHz, which gives 34 ms to 94 ms.
void startWatchdog();

inline void feedWatchdog() {
  iwdg().kr = 0xAAAA;
}

}  // namespace vibe_firmware::stm32
