#pragma once
#include <cstddef>
#include <cstdint>

// Registers of QEMU's mps2-an500 that the port uses. ARM DDI 0479, Cortex-M System Design Kit: 4.2 (timer), 4.3 (UART);
// ARMv7-M Architecture Reference Manual, B3.3 (SysTick).

namespace vibe_firmware::mps2 {

using Register = volatile std::uint32_t;

constexpr std::uint32_t kClock = 25000000;  ///< of processor, SysTick and timers [Hz]
constexpr std::uint32_t kCountsPerTick = kClock / 1000;

struct Uart {
  Register data;
  Register state;  // bit 0: transmitter full, bit 1: receiver full
  Register control;
  Register interrupt;
  Register divider;
};
static_assert(offsetof(Uart, divider) == 0x10);
constexpr std::uint32_t kTransmitterFull = 1, kReceiverFull = 2, kTransmitAndReceive = 3, kSmallestDivider = 16;

struct Timer {  // counts down
  Register control;
  Register value;
  Register reload;
  Register interrupt;
};
static_assert(offsetof(Timer, interrupt) == 0x0C);

struct SysTick {
  Register control;  // bit 0: on, bit 1: interrupt, bit 2: processor clock
  Register reload;
  Register value;
};

inline Uart& uart1() {
  return *reinterpret_cast<Uart*>(0x40005000);
}
inline Timer& timer1() {
  return *reinterpret_cast<Timer*>(0x40001000);
}
inline SysTick& sysTick() {
  return *reinterpret_cast<SysTick*>(0xE000E010);
}

}  // namespace vibe_firmware::mps2
