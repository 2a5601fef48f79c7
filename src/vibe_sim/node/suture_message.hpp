#pragma once
#include <vibe_msgs/SutureArray.h>

#include <cstdint>

#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

/// All threads and what bleeds, in the frame world.
vibe_msgs::SutureArray makeSutures(const Model& model, const State& state, std::int64_t stamp);

/// Differs from that of another procedure if listeners must hear of the change at once: bites, stages, techniques,
/// tears, bleeding; not places and tensions.
std::uint64_t kindOf(const ProcedureState& procedure);

}  // namespace vibe
