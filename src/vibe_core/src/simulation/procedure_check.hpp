#pragma once
#include <string>

#include "vibe_core/state/procedure_state.hpp"
#include "vibe_core/state/pull_spring.hpp"

namespace vibe {

/// What makes a stored procedure one that no session can have reached, e.g. "a bite holds a particle that does not
/// exist"; empty if nothing.
std::string findDamage(const ProcedureState& procedure, int particle_count);

/// The same of the hand that pulls the tissue.
std::string findDamage(const PullSpring& pull, int particle_count);

}  // namespace vibe
