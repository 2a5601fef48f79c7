#pragma once

#include <cstdint>

#include <vibe_msgs/SutureArray.h>

#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe::sim {

/// All threads and bleeding bites, in the frame world.
vibe_msgs::SutureArray makeSutures(const Model& model, const State& state, std::int64_t stamp);

/// A number that changes when listeners must be told at once: bites, stages, techniques, tears, bleeding. It does not
/// depend on positions and tensions.
std::uint64_t kindOf(const ProcedureState& procedure);

}  // namespace vibe::sim
