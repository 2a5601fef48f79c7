#pragma once
#include <cstdint>

// This port has never run on hardware.

namespace vibe_firmware::stm32 {

constexpr std::uint32_t kCoreClock = 216000000;   ///< processor and TIM1 [Hz]
constexpr std::uint32_t kTimerClock = 108000000;  ///< TIM3 to TIM6 [Hz]
constexpr std::uint32_t kApb1Clock = 54000000;    ///< USART3 [Hz]

/// Instruction cache on; 216 MHz for the processor and 48 MHz for USB from the 8 MHz that the debugger of a Nucleo
/// board feeds into OSC_IN; clocks of the peripherals that are used. Waits for ever if the 8 MHz are missing.
void startClocks();

}  // namespace vibe_firmware::stm32
