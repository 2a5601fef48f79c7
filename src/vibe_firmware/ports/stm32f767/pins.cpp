#include "pins.hpp"

#include <initializer_list>

namespace vibe_firmware::stm32 {

void configurePin(Gpio& port, unsigned pin, Mode mode, Pull pull, unsigned function) {
  setField(port.afr[pin / 8], pin % 8 * 4, 15, function);
  setField(port.pupdr, pin * 2, 3, static_cast<std::uint32_t>(pull));
  setField(port.ospeedr, pin * 2, 3, 1);  // 25 MHz is enough for 50 kHz and slow edges radiate less
  setField(port.moder, pin * 2, 3, static_cast<std::uint32_t>(mode));
}

void configurePins() {
  gpioE().bsrr = bit(kBridgeSleepPin + 16);
  configurePin(gpioE(), kBridgeSleepPin, Mode::Output, Pull::None);
  for (const unsigned pin : {9, 11, 13, 14}) configurePin(gpioE(), pin, Mode::Alternate, Pull::Down, 1);  // TIM1 CH1-4
  configurePin(gpioE(), 15, Mode::Alternate, Pull::Up, 1);                                                // TIM1 BKIN
  for (const unsigned pin : {6, 7, 8}) configurePin(gpioC(), pin, Mode::Alternate, Pull::Up, 2);          // TIM3 CH1-3
  for (const unsigned pin : {12, 13, 14}) configurePin(gpioD(), pin, Mode::Alternate, Pull::Up, 2);       // TIM4 CH1-3
  for (unsigned pin = 0; pin < kButtons; ++pin) configurePin(gpioF(), pin, Mode::Input, Pull::Up);
  configurePin(gpioD(), 8, Mode::Alternate, Pull::None, 7);  // USART3 TX, to the debugger
}

}  // namespace vibe_firmware::stm32
