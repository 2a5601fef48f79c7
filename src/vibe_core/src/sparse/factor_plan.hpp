#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "sparse/panel_kernel.hpp"
#include "vibe_core/sparse/factor.hpp"

namespace vibe {

/// Operations per second that may go into a factor which the background renews while a wall moves [1/s]. Design choice:
/// half of what a core does in single precision, so that stiffness, columns and a machine with other work fit in.
constexpr double kFactorRate = 1.2e10;

/// The elimination order, its supernodes, and the source and destination of all data of a supernode. Rows and columns
/// are scalar (3 per node) and in elimination order unless stated otherwise.
class FactorPlan {
 public:
  /// A block of the matrix in the front of a supernode; row and column are relative to the first of the front.
  struct Entry {
    int block;  ///< -1 - node: the diagonal block of the node; else index into BlockMatrix::lower(), and on from its
                ///< end into BlockMatrix::coupled()
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

  /// A subtree of supernodes, which is independent of the others.
  struct Branch {
    int first, last;     ///< supernodes, past the last
    std::int64_t stack;  ///< index of its first number among all update matrices
    int largest_front;   ///< rows
  };
  /// What one thread substitutes in: a branch, or a supernode of the trunk. What its forward substitution adds to rows
  /// beyond it is recorded. A supernode of the trunk adds all that was recorded for its rows before it begins, in the
  /// order of the supernodes, so that the sums are those of one pass over all.
  struct Task {
    int first, last;         ///< supernodes, past the last
    std::int32_t end_row;    ///< past its last row
    std::int64_t record;     ///< index of its first recorded number
    int parent, children;    ///< the task with the parent of its last supernode, -1: none or `root`; how many it has
    int received, receipts;  ///< index into `receipts` and number of what it adds
  };
  /// Recorded numbers of one supernode for rows of another.
  struct Receipt {
    std::int64_t record;  ///< index of the first number
    std::int64_t index;   ///< into row_index, of the first node
    int nodes;
  };

  std::shared_ptr<const BlockPattern> pattern;
  std::vector<NodePair> pairs;  ///< beside the pattern
  std::vector<int> order;       ///< nodes by position in the elimination
  std::vector<int> position;    ///< the inverse permutation
  std::vector<int> holder;      ///< supernode by position in the elimination
  std::vector<PanelStep> steps;
  std::vector<std::int32_t> row_index;  ///< see PanelStep
  std::vector<Front> fronts;
  std::vector<Entry> entries;
  std::vector<Run> runs;
  std::vector<Branch> branches;        ///< ascending; the supernodes between and after them are the trunk
  std::vector<Task> tasks;             ///< all but `root`, children first, in an order in which few wait for others
  std::vector<int> backward;           ///< the same, parents first
  Task root{0, 0, 0, 0, -1, 0, 0, 0};  ///< the last supernode, which threads share by rows; first == last: none
  std::vector<Receipt> receipts;
  std::int64_t record_size = 0;  ///< of all tasks
  std::int64_t panel_size = 0;   ///< numbers in total, padding included
  std::int64_t nonzeros = 0;
  std::int64_t stack_size = 0;  ///< of the update matrices, a stack for the trunk and one for each branch [numbers]
  double operations = 0;        ///< to make a factor: products that are added or subtracted
  int largest_front = 0;        ///< rows
};

}  // namespace vibe
