#pragma once
#include <cstdint>
#include <vector>

#include "vibe_hardware/emulator/hand.hpp"

namespace vibe::hardware {

/// Between which limits a random hand moves a joint.
struct RandomRange {
  double low = 0, high = 0;  ///< [m], [rad]
  double speed = 0;          ///< never exceeded after the start [m/s], [rad/s]
};

/// The scope within the stomach. Speeds are below those of the endoscope's joints (URDF).
constexpr std::array<RandomRange, kScopeJointCount> kRandomRanges{
    {{0, 0.2, 0.1}, {-2, 2, 2}, {-1, 2, 2}, {-1.2, 1.2, 2}}};

/// Wanders about at random: each joint is a sum of sinusoids with frequencies of 0.05 to 0.5 Hz and random phases,
/// scaled so that it stays within its range and below its speed at all times. In the first two seconds it leaves 0.
/// Buttons are pressed for 0.3 to 2 s at random times. A pure function of seed and time; the same on every machine with
/// the same libm. Never ends.
class RandomHand : public Hand {
 public:
  explicit RandomHand(std::uint64_t seed, const std::array<RandomRange, kScopeJointCount>& ranges = kRandomRanges);

  HandSample at(double time) const override;
  double duration() const override;

 private:
  struct Wave {
    double frequency;  // [rad/s]
    double phase;      // [rad]
    double amplitude;  // [m], [rad]
  };
  std::uint64_t seed_;
  std::array<double, kScopeJointCount> middle_{};
  std::array<std::vector<Wave>, kScopeJointCount> waves_;
};

}  // namespace vibe::hardware
