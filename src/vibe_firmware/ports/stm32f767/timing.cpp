#include "timing.hpp"

#include "clocks.hpp"

namespace vibe_firmware::stm32 {

void startTiming() {
  constexpr std::uint32_t kPerMicrosecond = kTimerClock / 1000000;
  tim5().psc = kPerMicrosecond - 1;
  tim5().arr = 0xFFFFFFFF;
  tim5().egr = 1;  // loads the prescaler
  tim5().cr1 = 1;
  tim6().psc = kPerMicrosecond - 1;
  tim6().arr = 1000 - 1;
  tim6().egr = 1;
  tim6().sr = 0;
  tim6().dier = 1;
  tim6().cr1 = 1;
  enableInterrupt(kTim6Interrupt, 0);
}

void startWatchdog() {
  iwdg().kr = 0xCCCC;  // start, which also starts its clock
  iwdg().kr = 0x5555;  // allow the two writes below
  iwdg().pr = 0;       // 32 kHz / 4
  iwdg().rlr = 400 - 1;
  while (iwdg().sr != 0) {
  }
  feedWatchdog();
}

}  // namespace vibe_firmware::stm32
