#pragma once

#include <vector>

#include "sparse/block_matrix.hpp"

namespace vibe {

/// A fill-reducing order of the nodes: order[k] is eliminated k-th. Nested dissection by METIS; the same for the same
/// pattern and seed.
std::vector<int> nestedDissection(const BlockPattern& pattern, int seed);

/// A group of nodes that are eliminated together as one dense block, over a tree of such groups.
struct Supernode {
  std::vector<int> nodes;  ///< eliminated here
  std::vector<int> rows;   ///< nodes eliminated later that couple with them, fill included
  int parent = -1;         ///< -1: a root
};

/// The widest supernodes without any entry that is not fill: parents come after their children. Node numbers are those
/// of the pattern.
std::vector<Supernode> symbolicFactor(const BlockPattern& pattern, std::vector<int> order);

/// Cycles that forward and backward substitution spend on a supernode of so many nodes and further rows (in nodes).
double solveCost(int nodes, int rows);

/// Merges supernodes into their parents wherever the zeros that this stores cost less than handling two supernodes.
/// The result is in postorder: the nodes of its groups, one group after another, are the order of elimination.
std::vector<Supernode> amalgamate(std::vector<Supernode> supernodes);

}  // namespace vibe
