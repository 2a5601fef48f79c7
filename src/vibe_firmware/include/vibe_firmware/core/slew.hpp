#pragma once

namespace vibe_firmware {

/// `value` moved towards `target` by at most `step`.
constexpr float approach(float value, float target, float step) {
  if (value < target - step) return value + step;
  if (value > target + step) return value - step;
  return target;
}

constexpr float clamp(float value, float limit) {
  if (value > limit) return limit;
  if (value < -limit) return -limit;
  return value;
}

}  // namespace vibe_firmware
