#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "vibe_core/input/step_input.hpp"

namespace vibe {

/// What a trainee's hands add to what they mean to do.
struct TremorSettings {
  double low_frequency = 8;                     ///< [Hz]
  double high_frequency = 12;                   ///< [Hz]
  std::array<double, kJointCount> amplitude{};  ///< root mean square per joint [m], [rad]
  double scale = 1;                             ///< multiplies all amplitudes
};

/// Involuntary movement of the hands: per joint a sum of sinusoids whose frequencies are spread over a band and whose
/// phases are random. Physiological tremor of the hand lies at 8 to 12 Hz: Elble & Randall 1976, J Neurophysiol
/// 39(2):370. Pure function of seed and time, mean zero over long times.
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
