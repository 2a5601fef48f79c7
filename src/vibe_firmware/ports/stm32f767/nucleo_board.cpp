#include "nucleo_board.hpp"

#include <initializer_list>

#include "clocks.hpp"
#include "registers.hpp"

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

void configurePin(Gpio& port, unsigned pin, Mode mode, Pull pull, unsigned function) {
  setField(port.afr[pin / 8], pin % 8 * 4, 15, function);
  setField(port.pupdr, pin * 2, 3, static_cast<std::uint32_t>(pull));
  setField(port.ospeedr, pin * 2, 3, 1);  // 25 MHz is enough for 50 kHz and slow edges radiate less
  setField(port.moder, pin * 2, 3, static_cast<std::uint32_t>(mode));
}

void configurePins() {
  gpioE().bsrr = bit(kBridgeSleepPin + 16);
  configurePin(gpioE(), kBridgeSleepPin, Mode::Output, Pull::None);
  for (const unsigned pin : {9, 11, 13, 14}) configurePin(gpioE(), pin, Mode::Alternate, Pull::Down, 1);  // TIM1 CH1-4
  configurePin(gpioE(), 15, Mode::Alternate, Pull::Up, 1);                                                // TIM1 BKIN
  for (const unsigned pin : {6, 7, 8}) configurePin(gpioC(), pin, Mode::Alternate, Pull::Up, 2);          // TIM3 CH1-3
  for (const unsigned pin : {12, 13, 14}) configurePin(gpioD(), pin, Mode::Alternate, Pull::Up, 2);       // TIM4 CH1-3
  for (unsigned pin = 0; pin < kButtons; ++pin) configurePin(gpioF(), pin, Mode::Input, Pull::Up);
  configurePin(gpioD(), 8, Mode::Alternate, Pull::None, 7);  // USART3 TX, to the debugger
}

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
