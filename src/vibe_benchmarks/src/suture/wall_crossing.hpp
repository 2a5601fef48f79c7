#pragma once
#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe::benchmarks {

/// Whether the mid-surface of the wall intersects itself.
bool wallsCross(const Model& model, const State& state);

}  // namespace vibe::benchmarks
