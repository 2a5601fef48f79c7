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
/// have it. Only solvers that step implicitly use blocks; the others reject a model for which the factory makes one.
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

/// For solvers without blocks.
/// @throws vibe::Error if an added kind makes a block for the model
void rejectAddedConstraints(const Model& model);

}  // namespace vibe
