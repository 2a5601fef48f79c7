#pragma once

#include <vector>

#include "tissue/element_batch.hpp"

namespace vibe {

/// Pieces of a shell that are evaluated at the same time as others, with node vectors of their own. These hold the
/// nodes that no piece before them has, then, for every time that they add to one of the others, a copy of it: where
/// the gradients of copies are added to their nodes in order, the sums are those of one piece after the other, to the
/// bit.
struct ShellPart {
  int first_piece, last_piece;     ///< past the last
  int first_batch;                 ///< of them
  std::vector<BatchOffsets> node;  ///< as ShellSweep::node, from there on, into the vectors of the part
  std::vector<int> own, copies;    ///< nodes
  std::size_t size() const { return 4 * (own.size() + copies.size()); }  ///< of its node vectors
};

}  // namespace vibe
