#pragma once

#include <memory>

#include "vibe_core/constraints/constraint_block.hpp"

namespace vibe {

/// Sutures that pull by their thread (suture.cinch_model: thread): an attachment point per bite, a thread per suture.
/// Null in a scene with other sutures or none.
std::unique_ptr<ConstraintBlock> makeThreadBlock(const Model& model);

}  // namespace vibe
