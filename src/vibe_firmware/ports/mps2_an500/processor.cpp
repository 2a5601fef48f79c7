#include "semihosting.hpp"
#include "startup.hpp"

// Vector table of mps2-an500. The only interrupt is SysTick.

extern "C" {

extern char linkStackTop[];

__attribute__((section(".vectors"), used)) void (*const vectors[16 + 32])() = {
    reinterpret_cast<void (*)()>(linkStackTop),
    resetHandler,
    faultHandler,
    faultHandler,
    faultHandler,
    faultHandler,
    faultHandler,
    nullptr,
    nullptr,
    nullptr,
    nullptr,
    faultHandler,
    faultHandler,
    nullptr,
    faultHandler,
    tickHandler,
    faultHandler,
};

void initialiseProcessor() {}

void halt() {
  vibe_firmware::semihosting::exit(99);
}
}
