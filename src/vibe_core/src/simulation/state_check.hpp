#pragma once
#include <string>

#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

/// What makes a stored state one that no session of the model can have reached, e.g. "a bite holds a particle that does
/// not exist"; empty if nothing does.
std::string findDamage(const State& state, const Model& model);

}  // namespace vibe
