#include "motor_pwm.hpp"

#include "registers.hpp"

namespace vibe_firmware::stm32 {

void startPwm() {
  constexpr std::uint32_t kPwmMode1 = 6U << 4 | bit(3);  // high while counter < compare; compare takes effect at once a
                                                         // period has ended
  tim1().arr = kPwmPeriod - 1;
  tim1().ccmr1 = kPwmMode1 | kPwmMode1 << 8;
  tim1().ccmr2 = kPwmMode1 | kPwmMode1 << 8;
  tim1().ccer = bit(0) | bit(4) | bit(8) | bit(12);
  writeBridge(0, slowDecay(0, kPwmPeriod));
  writeBridge(1, slowDecay(0, kPwmPeriod));
  tim1().egr = 1;                                        // loads the compare values
  tim1().bdtr = bit(10) | bit(11) | bit(12) | 3U << 16;  // idle level driven, break on low, 8 samples
  tim1().sr = 0;                                         // forget a break that came before
  setBits(tim1().bdtr, bit(15));                         // outputs on
  tim1().cr1 = bit(7) | bit(0);
}

void writeBridge(std::size_t axis, const BridgeInputs& inputs) {
  (axis == 0 ? tim1().ccr1 : tim1().ccr3) = inputs.first;
  (axis == 0 ? tim1().ccr2 : tim1().ccr4) = inputs.second;
}

bool bridgeFault() {
  return tim1().sr & bit(7);  // BIF
}

void stopPwm() {
  tim1().bdtr = tim1().bdtr & ~bit(15);
}

}  // namespace vibe_firmware::stm32
