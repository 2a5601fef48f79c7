#pragma once
#include "encoders.hpp"
#include "motor_pwm.hpp"
#include "pins.hpp"
#include "timing.hpp"
#include "vibe_firmware/hal/board.hpp"

// This port has never run on hardware.

namespace vibe_firmware::stm32 {

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
