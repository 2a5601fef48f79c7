#pragma once

#include <memory>

#include "vibe_core/constraints/constraint_block.hpp"

namespace vibe {

/// The spring from outside, see pull_spring.hpp: it acts on the weighted mean of a patch of the wall.
std::unique_ptr<ConstraintBlock> makePullSpringBlock(const Model& model);

}  // namespace vibe
