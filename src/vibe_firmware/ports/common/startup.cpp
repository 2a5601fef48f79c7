#include "startup.hpp"

#include <cstdint>

// Start of every image: copies .data, clears .bss, switches the FPU on, runs constructors, calls run(). Replaces
// crt0 of newlib, which would bring a heap.

extern "C" {
extern std::uint32_t linkDataLoad[], linkDataBegin[], linkDataEnd[], linkBssBegin[], linkBssEnd[];
using Constructor = void (*)();
extern Constructor linkConstructorsBegin[], linkConstructorsEnd[];
}

namespace {

// ARMv7-M Architecture Reference Manual, B3.2.20: full access to coprocessors 10 and 11
void enableFpu() {
  auto* cpacr = reinterpret_cast<volatile std::uint32_t*>(0xE000ED88);
  *cpacr = *cpacr | 0xFU << 20;
  asm volatile("dsb\n isb" ::: "memory");
}

void initialiseMemory() {
  const std::uint32_t* from = linkDataLoad;
  for (std::uint32_t* to = linkDataBegin; to < linkDataEnd; ++to) *to = *from++;
  for (std::uint32_t* to = linkBssBegin; to < linkBssEnd; ++to) *to = 0;
}

}  // namespace

extern "C" {

void resetHandler() {
  initialiseMemory();
  enableFpu();
  initialiseProcessor();
  for (Constructor* constructor = linkConstructorsBegin; constructor < linkConstructorsEnd; ++constructor)
    (*constructor)();
  run();
  halt();
}

void faultHandler() {
  halt();
}

// Called where a pure virtual function of an object under construction is called.
void __cxa_pure_virtual() {
  halt();
}

void* __dso_handle = nullptr;
}

// The instructions between the two labels are what an interrupt costs. Written in assembly so that both exist exactly
// once, whatever the compiler inlines.
asm(R"(
  .syntax unified
  .thumb
  .section .text.tickHandler, "ax"
  .global tickHandler
  .global tickReturn
  .type tickHandler, %function
  .thumb_func
tickHandler:
  push {r4, lr}
  bl tick
tickReturn:
  pop {r4, pc}
  .size tickHandler, . - tickHandler
)");
