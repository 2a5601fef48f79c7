#include "usb_board.hpp"

#include <algorithm>

#include "startup.hpp"

namespace vibe_firmware::mps2 {
namespace {

// Triangle wave, 0 at tick 0.
std::int32_t triangle(std::uint32_t tick, std::uint32_t period, std::int32_t amplitude) {
  const std::uint32_t phase = (tick + period / 4) % period;
  const std::uint32_t up = std::min(phase, period - phase);
  const auto quarter = static_cast<std::int32_t>(period / 4);
  return (static_cast<std::int32_t>(up) - quarter) * amplitude / quarter;
}

}  // namespace

HapticSample SimulatedEncoders::next() {
  if (scripted_) followScript();
  HapticSample sample;
  for (int axis = 0; axis < kAxisCount; ++axis) {
    counts_[axis] += std::clamp(targets_[axis] - counts_[axis], -kMaxSpeed, kMaxSpeed);
    sample.counter[axis] = static_cast<std::uint32_t>(counts_[axis]);
  }
  sample.buttons = buttons_;
  return sample;
}

void SimulatedEncoders::followScript() {
  targets_ = {triangle(tick_, 4000, 10000), triangle(tick_, 6000, 10000)};
  buttons_ = static_cast<std::uint16_t>(1U << tick_ / 500 % 6);
  ++tick_;
}

void SimulatedEncoders::moveTo(const std::array<std::int32_t, kAxisCount>& counts, std::uint16_t buttons) {
  disableInterrupts();
  targets_ = counts;
  buttons_ = buttons;
  scripted_ = false;
  enableInterrupts();
}

}  // namespace vibe_firmware::mps2
