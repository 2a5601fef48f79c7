#pragma once

#include <memory>

#include "vibe_core/constraints/constraint_block.hpp"

namespace vibe {

/// The gas in the lumen, isothermal, and the insufflator. Null in a scene without gas.
std::unique_ptr<ConstraintBlock> makeGasBlock(const Model& model);

}  // namespace vibe
