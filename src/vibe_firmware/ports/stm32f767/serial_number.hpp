#pragma once

// This port has never run on hardware.

namespace vibe_firmware::stm32 {

/// The unique number of the chip as 24 hexadecimal digits; RM0410, chapter device electronic signature.
const char* serialNumber();

}  // namespace vibe_firmware::stm32
