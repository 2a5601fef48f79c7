#include "clocks.hpp"
#include "nucleo_board.hpp"
#include "startup.hpp"

// Vector table of STM32F767. This port has never run on hardware.

extern "C" {

extern char linkStackTop[];
void usbHandler();  ///< of the USB link

using Handler = void (*)();

#define FAULT4 faultHandler, faultHandler, faultHandler, faultHandler
#define FAULT16 FAULT4, FAULT4, FAULT4, FAULT4

// clang-format off
__attribute__((section(".vectors"), used)) Handler const vectors[16 + 110] = {
    reinterpret_cast<Handler>(linkStackTop), resetHandler, faultHandler, faultHandler,
    faultHandler, faultHandler, faultHandler, nullptr, nullptr, nullptr, nullptr, faultHandler,
    faultHandler, nullptr, faultHandler, faultHandler,
    FAULT16, FAULT16, FAULT16, FAULT4, faultHandler, faultHandler,       // 0 to 53
    tickHandler,                                                         // 54: TIM6
    FAULT4, FAULT4, FAULT4,                                              // 55 to 66
    usbHandler,                                                          // 67: OTG_FS
    FAULT16, FAULT16, FAULT4, FAULT4, faultHandler, faultHandler,        // 68 to 109
};
// clang-format on
#undef FAULT16
#undef FAULT4

void initialiseProcessor() {
  vibe_firmware::stm32::startClocks();
}

// The motors coast; the watchdog, if it runs already, resets the board.
void halt() {
  vibe_firmware::stm32::stopPwm();
  for (;;) asm volatile("");
}
}
