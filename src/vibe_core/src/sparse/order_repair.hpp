#pragma once

#include <vector>

#include "sparse/factor_plan.hpp"

namespace vibe {

/// An elimination order for a pattern with further pairs of nodes, from that of the pattern. A pair of nodes of which
/// neither is an ancestor of the other in the supernode tree would fill the whole path of one of them; therefore one
/// node of each such pair moves up, to the front of the lowest supernode that is an ancestor of both. Nodes with many
/// pairs move first (a greedy vertex cover), so that few do.
/// Zarebavani et al., "Parth: Adaptive Fill-Reducing Ordering", ACM Trans. Graph. 44 (2025), doi 10.1145/3731179.
std::vector<int> repairedOrder(const FactorPlan& base, const std::vector<NodePair>& pairs);

}  // namespace vibe
