#include "tick_timer.hpp"

#include "registers.hpp"

namespace vibe_firmware::mps2 {

void startTicks() {
  timer1().reload = 0xFFFFFFFF;
  timer1().value = 0xFFFFFFFF;
  timer1().control = 1;
  sysTick().reload = kCountsPerTick - 1;
  sysTick().value = 0;
  sysTick().control = 7;
}

std::uint32_t counts() {
  return 0xFFFFFFFF - timer1().value;
}

std::uint32_t MicrosecondClock::update() {
  constexpr std::uint32_t kCountsPerMicrosecond = kClock / 1000000;
  const std::uint32_t now = counts();
  const std::uint32_t elapsed = now - last_counts_ + remainder_;
  last_counts_ = now;
  remainder_ = elapsed % kCountsPerMicrosecond;
  microseconds_ += elapsed / kCountsPerMicrosecond;
  return microseconds_;
}

}  // namespace vibe_firmware::mps2
