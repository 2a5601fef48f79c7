#pragma once

#include <memory>

#include "vibe_core/constraints/constraint_block.hpp"

namespace vibe {

/// Parts of the wall that meet, see SelfContact. Null without tissue.self_contact.
std::unique_ptr<ConstraintBlock> makeSelfContactBlock(const Model& model);

}  // namespace vibe
