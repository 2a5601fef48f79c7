#pragma once

#include <cstddef>
#include <cstdint>

#include "registers.hpp"
#include "vibe_firmware/core/sample.hpp"
#include "vibe_firmware/hal/board.hpp"
#include "vibe_firmware/hal/motor_drive.hpp"

// This port has never run on hardware.

namespace vibe_firmware::stm32 {

/// TIM3 and TIM4 count both edges of both channels (RM0410, TIM2 to TIM5, encoder interface mode) and capture the
/// counter at the rising edge of the index on channel 3. 16 bits.
void startEncoders();

/// Fills counters and index pulses.
void readEncoders(HapticSample& sample);

constexpr std::uint32_t kPwmPeriod = 4320;  ///< 50 kHz [counts of 216 MHz]; the winding's L/R is 21 us

/// TIM1 drives the inputs of bridge 0 on channels 1 and 2, those of bridge 1 on 3 and 4. All high: both motors brake.
/// A low level on BKIN, the fault output of the bridges, switches all channels low until the board is reset.
void startPwm();

void writeBridge(std::size_t axis, const BridgeInputs& inputs);

/// The bridges have reported a fault; both motors coast.
bool bridgeFault();

/// All inputs low: both motors coast.
void stopPwm();

// Pins of a Nucleo-144 with STM32F767ZI; docs/hardware.md has the same list as a table for wiring. Alternate functions:
// STM32F767 data sheet.

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

/// Nucleo-144 with STM32F767ZI and a dual H-bridge.
class NucleoBoard : public Board {
 public:
  explicit NucleoBoard(const std::array<MotorDrive, kAxisCount>& drives) : drives_(drives) {}

  HapticSample sample() override {
    HapticSample sample;
    readEncoders(sample);
    sample.buttons = pressedButtons();
    sample.drive_fault = bridgeFault();
    sample.time_us = microseconds();
    return sample;
  }

  void writeTorque(const std::array<float, kAxisCount>& torque) override {
    for (std::size_t axis = 0; axis < kAxisCount; ++axis)
      writeBridge(axis, slowDecay(dutyOf(drives_[axis], torque[axis]), kPwmPeriod));
  }

  void feedWatchdog() override { stm32::feedWatchdog(); }

 private:
  const std::array<MotorDrive, kAxisCount> drives_;
};

}  // namespace vibe_firmware::stm32
