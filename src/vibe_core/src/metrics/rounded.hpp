#pragma once
#include <cmath>

namespace vibe {

/// To so many decimals, for texts; never -0.
inline double rounded(double value, int decimals) {
  double scale = 1;
  for (int k = 0; k < decimals; ++k) scale *= 10;
  const double result = std::round(value * scale) / scale;
  return result == 0 ? 0 : result;
}

}  // namespace vibe
