#pragma once

#include <memory>

#include "vibe_core/constraints/constraint_block.hpp"

namespace vibe {

/// Sutures that pull by groups of particles (suture.cinch_model: groups), see GroupPull. Null in a scene with other
/// sutures or none.
std::unique_ptr<ConstraintBlock> makeGroupBlock(const Model& model);

}  // namespace vibe
