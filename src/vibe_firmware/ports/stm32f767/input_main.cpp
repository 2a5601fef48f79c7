#include "image.hpp"
#include "serial_number.hpp"
#include "startup.hpp"
#include "vibe_firmware/protocol/input_function.hpp"

// The input device on a Nucleo-144 with STM32F767ZI. This port has never run on hardware.

namespace {

vibe_firmware::InputFunction device(vibe_firmware::InputConfig{}, vibe_firmware::stm32::serialNumber());
vibe_firmware::stm32::Image image(device);

}  // namespace

extern "C" void tick() {
  image.tick();
}

extern "C" void run() {
  image.run(false);
}
