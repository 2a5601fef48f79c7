#pragma once

namespace vibe_firmware {

/// Interrupts that fall due while they are disabled run when they are enabled again.
inline void disableInterrupts() {
  asm volatile("cpsid i" ::: "memory");
}

inline void enableInterrupts() {
  asm volatile("cpsie i" ::: "memory");
}

}  // namespace vibe_firmware

// Names that startup code, linker script, boards and tests share.

extern "C" {
void resetHandler();
void faultHandler();       ///< every exception and interrupt that nobody expects
void tickHandler();        ///< entry of the 1 kHz interrupt; calls tick()
extern char tickReturn[];  ///< its last instruction: tests count the instructions from tickHandler to here

void tick();                 ///< of the image: what runs at 1 kHz
void run();                  ///< of the image: its main loop; halt() follows if it returns
[[noreturn]] void halt();    ///< of the board: switches the motors off and stops for ever, or ends the emulation
void initialiseProcessor();  ///< of the board: clocks, caches; runs before constructors, after the FPU is on
}
