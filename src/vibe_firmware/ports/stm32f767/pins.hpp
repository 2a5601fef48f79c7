#pragma once
#include "registers.hpp"

// Pins of a Nucleo-144 with STM32F767ZI; docs/hardware.md has the same list as a table for wiring. Alternate functions:
// STM32F767 data sheet. This port has never run on hardware.

namespace vibe_firmware::stm32 {

enum class Mode : std::uint8_t { Input = 0, Output = 1, Alternate = 2 };
enum class Pull : std::uint8_t { None = 0, Up = 1, Down = 2 };

void configurePin(Gpio& port, unsigned pin, Mode mode, Pull pull, unsigned function = 0);

constexpr unsigned kBridgeSleepPin = 10;  ///< of port E: low, the bridges are off
constexpr unsigned kButtons = 14;         ///< pins 0 to 13 of port F, to ground; an open pin is not pressed

/// Configures all pins; the bridges sleep.
void configurePins();

/// Wakes the bridges and waits until they are awake: 1 ms (DRV8833); here 2 ms or more at 216 MHz.
inline void wakeBridges() {
  gpioE().bsrr = bit(kBridgeSleepPin);
  for (unsigned i = 0; i < 432'000; ++i) asm volatile("nop");
}

/// Bits 0 to 13: pressed.
inline std::uint16_t pressedButtons() {
  return static_cast<std::uint16_t>(~gpioF().idr & (bit(kButtons) - 1));
}

}  // namespace vibe_firmware::stm32
