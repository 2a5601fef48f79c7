#pragma once

#include <memory>

#include "vibe_core/constraints/constraint_block.hpp"

namespace vibe {

/// What the helix holds: each held particle is at its place in the link that carries the helix, at the end of the step.
/// Null without a tool.
std::unique_ptr<ConstraintBlock> makeGripBlock(const Model& model);

}  // namespace vibe
