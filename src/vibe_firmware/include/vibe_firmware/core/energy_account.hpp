#pragma once

namespace vibe_firmware {

/// Energy that an axis may still give to the hand [J]: what it has given is taken off, what the hand has put in is
/// added, up to a capacity. Sums with compensation (Knuth's two-sum), so that a million small amounts do not get lost.
struct EnergyAccount {
  float balance = 0;
  float error = 0;  ///< that rounding has left out of `balance`

  /// @param capacity  upper limit of the balance [J]
  void add(float energy, float capacity);
};

}  // namespace vibe_firmware
