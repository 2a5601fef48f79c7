#pragma once

#include <memory>

#include "vibe_core/constraints/constraint_block.hpp"

namespace vibe {

/// Particles that the tool touches: they stay outside its shapes, with Coulomb friction (scene.scope->friction). The
/// ends of the organ that are open pass through the tool; held particles do not touch. Null without a tool.
std::unique_ptr<ConstraintBlock> makeToolContactBlock(const Model& model);

}  // namespace vibe
