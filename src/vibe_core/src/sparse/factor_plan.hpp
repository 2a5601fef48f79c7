#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "sparse/factor.hpp"
#include "sparse/panel_kernel.hpp"

namespace vibe {

/// The order of elimination, its supernodes, and where everything of a supernode comes from and goes to. Rows and
/// columns are scalar (3 per node) and in elimination order unless said otherwise.
class FactorPlan {
 public:
  /// A block of the matrix in the front of a supernode; row and column count from the front's first.
  struct Entry {
    int block;  ///< index into BlockMatrix::lower(); -1 - node: the diagonal block of the node
    int row, column;
    bool transposed;
  };
  /// Consecutive rows of a supernode's update matrix that are consecutive rows of its parent's front.
  struct Run {
    int from, to, count;
  };
  struct Front {
    int parent = -1;
    int child_count = 0;
    int first_entry = 0, entry_count = 0;
    int first_run = 0, run_count = 0;
  };

  BlockPattern pattern;
  std::vector<int> order;     ///< nodes by place in the elimination
  std::vector<int> position;  ///< the reverse
  std::vector<int> holder;    ///< supernode by place in the elimination
  std::vector<PanelStep> steps;
  std::vector<std::int32_t> row_index;  ///< see PanelStep
  std::vector<Front> fronts;
  std::vector<Entry> entries;
  std::vector<Run> runs;
  std::int64_t panel_size = 0;  ///< numbers, padding included
  std::int64_t nonzeros = 0;
  std::int64_t stack_size = 0;  ///< numbers of update matrices that wait at the same time, at most
  int largest_front = 0;        ///< rows
};

}  // namespace vibe
