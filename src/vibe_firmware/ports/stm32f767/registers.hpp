#pragma once
#include <cstddef>
#include <cstdint>

// Registers of STM32F767 that the port uses. Offsets: the register maps of the chapters Flash, PWR, RCC, GPIO, TIM1,
// TIM2 to TIM5, TIM6, IWDG and USART of RM0410; they agree with ST's stm32f767xx.h (cmsis_device_f7). Addresses: memory
// map of RM0410. NVIC and SCB: PM0253, chapter 4.
//
// This port has never run on hardware.

namespace vibe_firmware::stm32 {

using Register = volatile std::uint32_t;

struct Flash {
  Register acr;
};

struct Power {
  Register cr1, csr1, cr2, csr2;
};
static_assert(offsetof(Power, csr1) == 0x04);

struct ResetClock {
  Register cr, pllcfgr, cfgr, cir;
  Register ahb1rstr, ahb2rstr, ahb3rstr, reserved0, apb1rstr, apb2rstr, reserved1[2];
  Register ahb1enr, ahb2enr, ahb3enr, reserved2, apb1enr, apb2enr, reserved3[2];
  Register ahb1lpenr, ahb2lpenr, ahb3lpenr, reserved4, apb1lpenr, apb2lpenr, reserved5[2];
  Register bdcr, csr, reserved6[2], sscgr, plli2scfgr, pllsaicfgr, dckcfgr1, dckcfgr2;
};
static_assert(offsetof(ResetClock, ahb1enr) == 0x30 && offsetof(ResetClock, apb1enr) == 0x40);
static_assert(offsetof(ResetClock, apb2enr) == 0x44 && offsetof(ResetClock, csr) == 0x74);
static_assert(offsetof(ResetClock, dckcfgr2) == 0x90);

struct Gpio {
  Register moder, otyper, ospeedr, pupdr, idr, odr, bsrr, lckr, afr[2];
};
static_assert(offsetof(Gpio, idr) == 0x10 && offsetof(Gpio, bsrr) == 0x18 && offsetof(Gpio, afr) == 0x20);

struct Timer {
  Register cr1, cr2, smcr, dier, sr, egr, ccmr1, ccmr2, ccer, cnt, psc, arr, rcr, ccr1, ccr2, ccr3, ccr4, bdtr;
};
static_assert(offsetof(Timer, sr) == 0x10 && offsetof(Timer, cnt) == 0x24 && offsetof(Timer, arr) == 0x2C);
static_assert(offsetof(Timer, ccr1) == 0x34 && offsetof(Timer, ccr3) == 0x3C && offsetof(Timer, bdtr) == 0x44);

struct IndependentWatchdog {
  Register kr, pr, rlr, sr, winr;
};
static_assert(offsetof(IndependentWatchdog, rlr) == 0x08);

struct Usart {
  Register cr1, cr2, cr3, brr, gtpr, rtor, rqr, isr, icr, rdr, tdr;
};
static_assert(offsetof(Usart, brr) == 0x0C && offsetof(Usart, isr) == 0x1C && offsetof(Usart, tdr) == 0x28);

template <typename Peripheral>
Peripheral& at(std::uintptr_t address) {
  return *reinterpret_cast<Peripheral*>(address);
}

// clang-format off
inline Timer& tim1() { return at<Timer>(0x40010000); }
inline Timer& tim3() { return at<Timer>(0x40000400); }
inline Timer& tim4() { return at<Timer>(0x40000800); }
inline Timer& tim5() { return at<Timer>(0x40000C00); }
inline Timer& tim6() { return at<Timer>(0x40001000); }
inline IndependentWatchdog& iwdg() { return at<IndependentWatchdog>(0x40003000); }
inline Usart& usart3() { return at<Usart>(0x40004800); }
inline Power& pwr() { return at<Power>(0x40007000); }
inline Gpio& gpioA() { return at<Gpio>(0x40020000); }
inline Gpio& gpioC() { return at<Gpio>(0x40020800); }
inline Gpio& gpioD() { return at<Gpio>(0x40020C00); }
inline Gpio& gpioE() { return at<Gpio>(0x40021000); }
inline Gpio& gpioF() { return at<Gpio>(0x40021400); }
inline ResetClock& rcc() { return at<ResetClock>(0x40023800); }
inline Flash& flash() { return at<Flash>(0x40023C00); }
// clang-format on

constexpr std::uint32_t bit(unsigned position) {
  return std::uint32_t{1} << position;
}

/// Replaces a field of a register.
inline void setField(Register& target, unsigned position, std::uint32_t mask, std::uint32_t value) {
  target = (target & ~(mask << position)) | value << position;
}

inline void setBits(Register& target, std::uint32_t bits) {
  target = target | bits;
}

/// Numbers of interrupts; RM0410, vector table. PM0253, chapter NVIC.
constexpr unsigned kTim6Interrupt = 54;
constexpr unsigned kUsbInterrupt = 67;

inline void enableInterrupt(unsigned number, std::uint8_t priority) {
  at<volatile std::uint8_t>(0xE000E400 + number) = priority;
  at<Register>(0xE000E100 + number / 32 * 4) = bit(number % 32);
}

}  // namespace vibe_firmware::stm32
