#pragma once
#include <cstddef>
#include <cstdint>

#include "vibe_firmware/hal/motor_drive.hpp"

// This port has never run on hardware.

namespace vibe_firmware::stm32 {

constexpr std::uint32_t kPwmPeriod = 4320;  ///< 50 kHz [counts of 216 MHz]; the winding's L/R is 21 us

/// TIM1 drives the inputs of bridge 0 on channels 1 and 2, those of bridge 1 on 3 and 4. All high: both motors brake.
/// A low level on BKIN, the fault output of the bridges, switches all channels low until the board is reset.
void startPwm();

void writeBridge(std::size_t axis, const BridgeInputs& inputs);

/// The bridges have reported a fault; both motors coast.
bool bridgeFault();

/// All inputs low: both motors coast.
void stopPwm();

}  // namespace vibe_firmware::stm32
