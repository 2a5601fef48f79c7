#include "image.hpp"
#include "serial_number.hpp"
#include "startup.hpp"
#include "vibe_firmware/protocol/haptic_function.hpp"

// The haptic device on a Nucleo-144 with STM32F767ZI. This port has never run on hardware.

namespace {

vibe_firmware::HapticFunction device(vibe_firmware::HapticConfig{}, vibe_firmware::stm32::serialNumber());
vibe_firmware::stm32::Image image(device);

}  // namespace

extern "C" void tick() {
  image.tick();
}

extern "C" void run() {
  image.run(true);
}
