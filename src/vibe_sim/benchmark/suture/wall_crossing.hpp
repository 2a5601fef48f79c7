#pragma once
#include "vibe_sim/model.hpp"
#include "vibe_sim/state.hpp"

namespace vibe {

/// Whether the middle surface of the wall crosses itself somewhere.
bool wallsCross(const Model& model, const State& state);

}  // namespace vibe
