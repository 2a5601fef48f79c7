#pragma once

#include <Eigen/Core>
#include <memory>
#include <utility>
#include <vector>

namespace vibe {

/// Sparsity pattern of a symmetric matrix of 3 x 3 blocks: the diagonal, and below it in row i the columns
/// column[start[i]] ... column[start[i + 1] - 1], ascending, all less than i. One block row per node.
struct BlockPattern {
  int size = 0;            ///< nodes
  std::vector<int> start;  ///< (size + 1)
  std::vector<int> column;

  /// Index in `column` of the block (row, column), column < row; -1: not in the pattern.
  int find(int row, int column_wanted) const;
};

/// The pattern in which all nodes of each group are coupled.
/// @param groups  consecutive groups of `group_size` node numbers; -1 entries are skipped
/// @throws Error  if a list does not consist of whole groups, or a node is outside the matrix
BlockPattern blockPattern(int size, const std::vector<std::pair<const std::vector<int>*, int>>& groups);

/// A symmetric matrix of 3 x 3 blocks over a shared pattern. Only the lower triangle is stored.
class BlockMatrix {
 public:
  explicit BlockMatrix(std::shared_ptr<const BlockPattern> pattern);

  void setZero();
  /// Multiplies every block.
  void scale(double factor);
  /// Adds a block at (row, column); for row < column its transpose is added at (column, row). On the diagonal the block
  /// must be symmetric.
  /// @throws Error  if the block is not in the pattern
  void add(int row, int column, const Eigen::Matrix3d& block);
  /// Replaces the rows and columns of a node by those of the unit matrix, which fixes the node.
  void fix(int node);
  /// out = A x, vectors of (3 * size), interleaved.
  void multiply(const double* x, double* out) const;

  const BlockPattern& pattern() const { return *pattern_; }
  const std::vector<Eigen::Matrix3d>& diagonal() const { return diagonal_; }
  const std::vector<Eigen::Matrix3d>& lower() const { return lower_; }

 private:
  std::shared_ptr<const BlockPattern> pattern_;
  std::vector<Eigen::Matrix3d> diagonal_, lower_;
  std::vector<int> column_start_, column_block_;  // the blocks of each column below the diagonal, for fix()
};

}  // namespace vibe
