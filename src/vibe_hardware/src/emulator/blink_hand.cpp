#include "vibe_hardware/emulator/blink_hand.hpp"

#include <algorithm>
#include <cmath>

#include "counter_random.hpp"
#include "vibe_core/common/error.hpp"

namespace vibe::hardware {
namespace {

constexpr double kAfter = 1;  // time the hand holds still after the last blink [s]

}  // namespace

BlinkHand::BlinkHand(const BlinkSetup& setup, std::shared_ptr<const Hand> other)
    : other_(std::move(other)), step_(setup.step) {
  if (other_ && !std::isfinite(other_->duration()))
    throw Error("A hand that blinks follows one that ends; give a script.");
  if (setup.count < 1 || !(setup.shortest > 0) || !(setup.longest >= setup.shortest))
    throw Error("A hand that blinks needs at least one blink, and a time between blinks above 0.");
  double time = (other_ ? other_->duration() : 0) + setup.begin;
  for (int i = 0; i < setup.count; ++i) {
    time += setup.shortest + (setup.longest - setup.shortest) * uniform(setup.seed, 0, static_cast<std::uint64_t>(i));
    blinks_.push_back(time);
  }
}

HandSample BlinkHand::at(double time) const {
  HandSample sample = other_ ? other_->at(time) : HandSample();
  const auto past = std::upper_bound(blinks_.begin(), blinks_.end(), time) - blinks_.begin();
  if (past % 2 == 1) sample.joints[TipLeftRight] += step_;
  return sample;
}

double BlinkHand::duration() const {
  return blinks_.back() + kAfter;
}

}  // namespace vibe::hardware
