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
