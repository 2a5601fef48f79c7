#pragma once

#include <cmath>
#include <string>

#include "vibe_core/metrics/skill_metrics.hpp"

namespace vibe {

/// To so many decimals, for texts; never -0.
inline double rounded(double value, int decimals) {
  double scale = 1;
  for (int k = 0; k < decimals; ++k) scale *= 10;
  const double result = std::round(value * scale) / scale;
  return result == 0 ? 0 : result;
}

/// The metrics as lines of text for people, without a trailing newline; what has no value is '-'.
std::string summarise(const SkillMetrics& metrics);

}  // namespace vibe
