#include "gamepad/force_effects.hpp"

#include <algorithm>
#include <cmath>

namespace vibe::hardware {
namespace {

double limited(double value, double low) {
  return std::isfinite(value) ? std::clamp(value, low, 1.0) : 0;
}

ff_effect newEffect(int type, int id) {
  ff_effect effect{};
  effect.type = static_cast<__u16>(type);
  effect.id = static_cast<__s16>(id);
  return effect;
}

}  // namespace

ff_effect rumbleEffect(double strong, double weak, int id) {
  ff_effect effect = newEffect(FF_RUMBLE, id);
  effect.u.rumble.strong_magnitude = static_cast<__u16>(std::lround(0xffff * limited(strong, 0)));
  effect.u.rumble.weak_magnitude = static_cast<__u16>(std::lround(0xffff * limited(weak, 0)));
  effect.replay.length = kRumbleTime;
  return effect;
}

ff_effect springEffect(const std::array<StickSpring, 2>& springs, int id) {
  ff_effect effect = newEffect(FF_SPRING, id);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    ff_condition_effect& condition = effect.u.condition[axis];
    const auto coefficient = static_cast<__s16>(std::lround(0x7fff * limited(springs[axis].coefficient, 0)));
    condition.left_saturation = condition.right_saturation = 0xffff;
    condition.left_coeff = condition.right_coeff = coefficient;
    condition.center = static_cast<__s16>(std::lround(0x7fff * limited(springs[axis].centre, -1)));
  }
  return effect;
}

}  // namespace vibe::hardware
