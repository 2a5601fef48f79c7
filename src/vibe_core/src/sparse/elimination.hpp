#pragma once

#include <vector>

#include "sparse/factor_plan.hpp"
#include "vibe_core/sparse/block_matrix.hpp"

namespace vibe {

/// A fill-reducing order of the nodes: order[k] is eliminated k-th. Nested dissection by METIS; deterministic for the
/// same pattern and seed.
std::vector<int> nestedDissection(const BlockPattern& pattern, int seed);

/// The pattern with further pairs of nodes.
/// @param pairs  sorted, each once, none in the pattern
BlockPattern extended(const BlockPattern& pattern, const std::vector<NodePair>& pairs);

/// A group of nodes that are eliminated together as one dense block; a node of the supernode tree.
struct Supernode {
  std::vector<int> nodes;  ///< eliminated here
  std::vector<int> rows;   ///< nodes eliminated later that are coupled with them, fill included
  int parent = -1;         ///< -1: a root
};

/// The largest supernodes that store no zeros. Parents come after their children. Node numbers are those of the
/// pattern.
std::vector<Supernode> symbolicFactor(const BlockPattern& pattern, std::vector<int> order);

/// Estimated cycles of forward and backward substitution for a supernode with this many nodes and further rows (in
/// nodes).
double solveCost(int nodes, int rows);

/// Merges supernodes into their parents where storing the additional zeros costs less than processing two supernodes.
/// The result is in postorder: the nodes of its groups in sequence are the elimination order.
std::vector<Supernode> amalgamate(std::vector<Supernode> supernodes);

/// An elimination order for a pattern with further pairs of nodes, from that of the pattern. A pair of nodes of which
/// neither is an ancestor of the other in the supernode tree would fill the whole path of one of them; therefore one
/// node of each such pair moves up, to the front of the lowest supernode that is an ancestor of both. Nodes with many
/// pairs move first (a greedy vertex cover), so that few do.
/// Zarebavani et al., "Parth: Adaptive Fill-Reducing Ordering", ACM Trans. Graph. 44 (2025), doi 10.1145/3731179.
std::vector<int> repairedOrder(const FactorPlan& base, const std::vector<NodePair>& pairs);

}  // namespace vibe
