#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "vibe_core/input/step_input.hpp"

namespace vibe {

/// Parameters of the tremor that is added to the intended motion.
struct TremorSettings {
  double low_frequency = 8;                     ///< [Hz]
  double high_frequency = 12;                   ///< [Hz]
  std::array<double, kJointCount> amplitude{};  ///< root mean square per joint [m], [rad]
  double scale = 1;                             ///< multiplies all amplitudes
};

/// Involuntary movement of the hands: for each joint a sum of sinusoids with frequencies spread over a band and random
/// phases. Physiological tremor of the hand lies at 8 to 12 Hz: Elble & Randall 1976, J Neurophysiol 39(2):370. A pure
/// function of seed and time, with zero mean over long times.
class Tremor {
 public:
  Tremor() = default;
  Tremor(const TremorSettings& settings, std::uint64_t seed);

  /// Displacement of a joint at time t [s] in [m] or [rad].
  double at(int joint, double time) const;

 private:
  struct Wave {
    double angular_frequency;  // [rad/s]
    double phase;              // [rad]
    double amplitude;          // [m], [rad]
  };
  std::array<std::vector<Wave>, kJointCount> waves_;
};

}  // namespace vibe
