#include "clocks.hpp"

#include "registers.hpp"

namespace vibe_firmware::stm32 {
namespace {

void waitFor(const Register& status, std::uint32_t bits) {
  while ((status & bits) != bits) {
  }
}

// PM0253, cache maintenance: invalidate, then enable. The data cache stays off: data are in DTCM, which is not cached.
void enableInstructionCache() {
  at<Register>(0xE000EF50) = 0;                // ICIALLU
  setBits(at<Register>(0xE000ED14), bit(17));  // CCR, IC
  asm volatile("dsb\n isb" ::: "memory");
}

// 8 MHz / 4 * 216 = 432 MHz; / 2 for the processor, / 9 for USB. RM0410, RCC_PLLCFGR.
void startPll() {
  setBits(rcc().cr, bit(18));  // HSEBYP: a clock, not a crystal
  setBits(rcc().cr, bit(16));  // HSEON
  waitFor(rcc().cr, bit(17));
  rcc().pllcfgr = 4 | 216 << 6 | 0 << 16 | bit(22) | 9 << 24 | 2 << 28;
  setBits(rcc().cr, bit(24));  // PLLON
}

// RM0410, PWR, entering over-drive mode: above 180 MHz the regulator has to be in over-drive.
void enterOverDrive() {
  setBits(pwr().cr1, bit(16));
  waitFor(pwr().csr1, bit(16));
  setBits(pwr().cr1, bit(17));
  waitFor(pwr().csr1, bit(17));
}

void switchToPll() {
  flash().acr = 7 | bit(8);  // wait states for 216 MHz at 3.3 V, prefetch; RM0410, Flash
  waitFor(rcc().cr, bit(25));
  setField(rcc().cfgr, 10, 7, 5);  // APB1 / 4
  setField(rcc().cfgr, 13, 7, 4);  // APB2 / 2
  setField(rcc().cfgr, 0, 3, 2);   // PLL
  while ((rcc().cfgr >> 2 & 3) != 2) {
  }
}

void enablePeripherals() {
  setBits(rcc().ahb1enr, bit(0) | bit(2) | bit(3) | bit(4) | bit(5));   // GPIO A, C, D, E, F
  setBits(rcc().apb1enr, bit(1) | bit(2) | bit(3) | bit(4) | bit(18));  // TIM3 to TIM6, USART3
  setBits(rcc().apb2enr, bit(0));                                       // TIM1
  asm volatile("dsb" ::: "memory");
}

}  // namespace

void startClocks() {
  enableInstructionCache();
  setBits(rcc().apb1enr, bit(28));  // PWR
  startPll();
  enterOverDrive();
  switchToPll();
  enablePeripherals();
}

}  // namespace vibe_firmware::stm32
