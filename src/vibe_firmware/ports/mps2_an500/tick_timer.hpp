#pragma once
#include <cstdint>

namespace vibe_firmware::mps2 {

/// Starts the 1 kHz interrupt and the clock.
void startTicks();

/// Counts of the clock since startTicks(), 25 MHz, wraps at 2^32.
std::uint32_t counts();

/// Time of ticks [us], wraps at 2^32. One instance, updated at each tick: the counts wrap after 172 s.
class MicrosecondClock {
 public:
  std::uint32_t update();

 private:
  std::uint32_t last_counts_ = 0;
  std::uint32_t remainder_ = 0;  // counts
  std::uint32_t microseconds_ = 0;
};

}  // namespace vibe_firmware::mps2
