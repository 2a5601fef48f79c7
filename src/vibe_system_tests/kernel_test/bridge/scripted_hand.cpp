#include "scripted_hand.hpp"

#include <cmath>

namespace vibe::hardware {
namespace {

constexpr std::int32_t kTravel = 10000;      // of axis 0: counts, and ticks there
constexpr double kSwing = 5000;              // of axis 1 [counts]
constexpr double kSwingTicks = 4000;         // of a full swing
constexpr std::uint32_t kButtonTicks = 250;  // that a button is held

}  // namespace

vibe_firmware::HapticSample scriptedHand(std::uint32_t tick) {
  const auto phase = static_cast<std::int32_t>(tick % (2 * kTravel));
  const std::int32_t there_and_back = phase < kTravel ? phase : 2 * kTravel - phase;
  const double angle = 2 * M_PI * tick / kSwingTicks;
  vibe_firmware::HapticSample sample;
  // the counters of the hardware have 16 bits
  sample.counter[0] = static_cast<std::uint16_t>(there_and_back);
  sample.counter[1] = static_cast<std::uint16_t>(std::lround(kSwing * std::sin(angle)));
  sample.buttons = static_cast<std::uint16_t>(1U << (tick / kButtonTicks % 16));
  sample.time_us = tick * 1000;
  return sample;
}

}  // namespace vibe::hardware
