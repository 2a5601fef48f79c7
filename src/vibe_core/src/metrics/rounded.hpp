#pragma once
#include <cmath>

namespace vibe {

/// To so many decimals, for texts; never -0.
inline double rounded(double value, int decimals) {
  const double scale = std::pow(10.0, decimals);
  const double result = std::round(value * scale) / scale;
  return result == 0 ? 0 : result;
}

}  // namespace vibe
