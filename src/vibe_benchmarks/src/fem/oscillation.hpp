#pragma once
#include <vector>

namespace vibe {

/// What a vibration about 0 does, from its values at equal steps.
struct Oscillation {
  double frequency = 0;  ///< from the first to the last crossing of 0 in the same direction [Hz]; NaN: under one period
  double kept = 0;       ///< amplitude over the one of a period before, mean over all periods; NaN: under one period
};

Oscillation measureOscillation(const std::vector<double>& values, double step);

}  // namespace vibe
