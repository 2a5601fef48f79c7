#pragma once

#include "vibe_core/state/state.hpp"

namespace vibe {

/// Position of a particle [m].
inline Eigen::Vector3d particleAt(int i, const State& state) {
  return {state.x[i], state.y[i], state.z[i]};
}

/// The cinch draws the last suture: its load changes from step to step.
inline bool isCinching(const State& state) {
  const std::vector<Suture>& sutures = state.procedure.sutures;
  return !sutures.empty() && sutures.back().stage == Suture::Stage::Cinching;
}

}  // namespace vibe
