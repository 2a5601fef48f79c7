#pragma once
#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

/// Whether the middle surface of the wall crosses itself somewhere.
bool wallsCross(const Model& model, const State& state);

}  // namespace vibe
