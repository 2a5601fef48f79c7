#pragma once

#include "vibe_core/state/state.hpp"

namespace vibe {

/// The cinch draws the last suture: its load changes from step to step.
inline bool isCinching(const State& state) {
  const std::vector<Suture>& sutures = state.procedure.sutures;
  return !sutures.empty() && sutures.back().stage == Suture::Stage::Cinching;
}

}  // namespace vibe
