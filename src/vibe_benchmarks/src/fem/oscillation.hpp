#pragma once
#include <vector>

namespace vibe::benchmarks {

/// Properties of a vibration about 0, from its values at equal steps.
struct Oscillation {
  double frequency =
      0;  ///< from the first to the last zero crossing in the same direction [Hz]; NaN: less than one period
  double kept =
      0;  ///< ratio of the amplitude to that one period earlier, mean over all periods; NaN: less than one period
};

Oscillation measureOscillation(const std::vector<double>& values, double step);

}  // namespace vibe::benchmarks
