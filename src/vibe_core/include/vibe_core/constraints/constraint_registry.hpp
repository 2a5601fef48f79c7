#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "vibe_core/constraints/constraint_block.hpp"

namespace vibe {

/// Makes the block of a model, or returns null where its scene does not need it.
using ConstraintFactory = std::function<std::unique_ptr<ConstraintBlock>(const Model&)>;

/// Adds a kind of constraint after those that exist. Simulations whose scratch memory (Workspace) is made from then on
/// have it. Solvers that divide the step use its substepLoad(); they reject a model for which the factory makes a block
/// without one.
/// Call it before simulations run, for example at the beginning of main(); any thread may call it.
/// @throws vibe::Error if the name is registered already
void registerConstraint(const std::string& name, ConstraintFactory factory);

/// Removes a kind added by registerConstraint(). Simulations that exist keep their block.
/// @throws vibe::Error if no such kind was added
void unregisterConstraint(const std::string& name);

/// Names of all kinds, in the order in which blocks are asked: those of the library, then those that were added.
std::vector<std::string> constraintNames();

/// The blocks of a model, in the order of constraintNames().
std::vector<std::unique_ptr<ConstraintBlock>> makeConstraintBlocks(const Model& model);

/// The blocks of the added kinds, for solvers that divide the step.
/// @throws vibe::Error if one of them has no substepLoad()
std::vector<std::unique_ptr<ConstraintBlock>> makeSubstepBlocks(const Model& model);

}  // namespace vibe
