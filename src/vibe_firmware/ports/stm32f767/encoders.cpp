#include "encoders.hpp"

namespace vibe_firmware::stm32 {
namespace {

constexpr std::uint32_t kFilter = 5;  // 8 equal samples at 54 MHz: edges closer than 148 ns are noise

void start(Timer& timer) {
  timer.ccmr1 = 1 | kFilter << 4 | 1 << 8 | kFilter << 12;  // channels 1 and 2 are inputs
  timer.ccmr2 = 1 | kFilter << 4;                           // so is channel 3
  timer.ccer = bit(0) | bit(4) | bit(8);
  timer.smcr = 3;  // encoder mode 3
  timer.arr = 0xFFFF;
  timer.cr1 = 1;
}

void read(Timer& timer, std::size_t axis, HapticSample& sample) {
  sample.index[axis] = timer.sr & bit(3);
  if (sample.index[axis]) sample.index_counter[axis] = timer.ccr3;  // clears the flag
  sample.counter[axis] = timer.cnt;
}

}  // namespace

void startEncoders() {
  start(tim3());
  start(tim4());
}

void readEncoders(HapticSample& sample) {
  read(tim3(), 0, sample);
  read(tim4(), 1, sample);
}

}  // namespace vibe_firmware::stm32
