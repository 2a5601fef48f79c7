#pragma once

namespace vibe_firmware {

/// One step of the low-pass filter v = a v + (1 - a) dx/T. Its gain at rest is 1, its time constant T / -ln a.
/// @param pole  a, in [0, 1)
/// @param speed  dx/T [rad/s]
constexpr float filteredVelocity(float pole, float velocity, float speed) {
  return pole * velocity + (1.0F - pole) * speed;
}

}  // namespace vibe_firmware
