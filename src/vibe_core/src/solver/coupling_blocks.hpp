#pragma once

#include <vector>

#include "vibe_core/sparse/block_matrix.hpp"
#include "vibe_core/state/stiffness_coupling.hpp"

namespace vibe {

/// The pairs of nodes that couplings connect and the pattern does not: sorted, each once, without fixed nodes.
/// @param fixed  per node
std::vector<NodePair> coupledPairs(const std::vector<StiffnessCoupling>& couplings, const std::vector<char>& fixed,
                                   const BlockPattern& pattern);

/// Adds the blocks of couplings to a matrix that has their pairs. Fixed nodes are left out.
void addCouplings(const std::vector<StiffnessCoupling>& couplings, const std::vector<char>& fixed, BlockMatrix& matrix);

}  // namespace vibe
