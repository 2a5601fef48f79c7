#pragma once

#include <algorithm>
#include <cstddef>

#include "vibe_core/state/state.hpp"

namespace vibe {

/// The square of the largest speed of a particle [m^2/s^2].
inline double maxSpeedSquared(const State& state) {
  const double *vx = state.vx.data(), *vy = state.vy.data(), *vz = state.vz.data();
  double max = 0;
  for (std::size_t i = 0; i < state.vx.size(); ++i) max = std::max(max, vx[i] * vx[i] + vy[i] * vy[i] + vz[i] * vz[i]);
  return max;
}

}  // namespace vibe
