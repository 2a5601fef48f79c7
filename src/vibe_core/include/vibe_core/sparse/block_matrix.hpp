#pragma once

#include <memory>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace vibe {

/// Sparsity pattern of a symmetric matrix of 3 x 3 blocks: the diagonal, and below it in row i the columns
/// column[start[i]] ... column[start[i + 1] - 1], ascending, all less than i. One block row per node.
struct BlockPattern {
  int size = 0;             ///< nodes
  std::vector<int> start;   ///< (size + 1)
  std::vector<int> column;  ///< of each block below the diagonal, row by row (start.back())

  /// Index in `column` of the block (row, column), column < row; -1: not in the pattern.
  int find(int row, int column_wanted) const;
};

/// Two nodes of which the first has the larger number: a block below the diagonal.
struct NodePair {
  int row, column;  ///< numbers of the two nodes, column < row
  bool operator==(const NodePair& other) const { return row == other.row && column == other.column; }
  bool operator<(const NodePair& other) const { return row != other.row ? row < other.row : column < other.column; }
};

/// The pattern in which all nodes of each group are coupled.
/// @param groups  consecutive groups of `group_size` node numbers; -1 entries are skipped
/// @throws Error  if a list does not consist of whole groups, or a node is outside the matrix
BlockPattern blockPattern(int size, const std::vector<std::pair<const std::vector<int>*, int>>& groups);

/// A symmetric matrix of 3 x 3 blocks over a shared pattern, and over a few pairs of nodes beside it that may change.
/// Only the lower triangle is stored.
class BlockMatrix {
 public:
  /// All blocks are zero, and no pairs are coupled.
  /// @param pattern  not null
  explicit BlockMatrix(std::shared_ptr<const BlockPattern> pattern);

  void setZero();  ///< all blocks; pattern and pairs stay
  /// Replaces the pairs of nodes beside the pattern; their blocks are zero.
  /// @param pairs  sorted, each once, none in the pattern
  void couple(const std::vector<NodePair>& pairs);
  /// Multiplies every block.
  void scale(double factor);
  /// Adds a block at (row, column); for row < column its transpose is added at (column, row). On the diagonal the block
  /// must be symmetric.
  /// @throws Error  if the block is neither in the pattern nor among the coupled pairs
  void add(int row, int column, const Eigen::Matrix3d& block);
  /// Where the blocks of groups of nodes are, for addAt(): per group and its members a >= b, in the order (0, 0), (1,
  /// 0), (1, 1), (2, 0), ... Computed once for a list and kept, so that assembly does not search.
  /// @param groups  as for blockPattern()
  /// @throws Error  if a block is not in the pattern
  const std::vector<int>& placesOf(const std::vector<int>& groups, int group_size);
  static constexpr int kNowhere = -(1 << 30);  ///< place of a pair with a member that is -1
  /// Adds a block at a place. @param block  row and column as the members a and b
  template <class Block>
  void addAt(int place, const Block& block) {
    if (place >= 0 && (place & 1) == 0)
      lower_[static_cast<std::size_t>(place) / 2] += block;
    else if (place >= 0)
      lower_[static_cast<std::size_t>(place) / 2] += block.transpose();
    else
      diagonal_[static_cast<std::size_t>(-1 - place)] += block;
  }
  /// Replaces the rows and columns of a node by those of the unit matrix, which fixes the node.
  void fix(int node);
  /// out = A x, vectors of (3 * size), interleaved.
  void multiply(const double* x, double* out) const;

  const BlockPattern& pattern() const { return *pattern_; }                   ///< as constructed, without pairs()
  const std::vector<Eigen::Matrix3d>& diagonal() const { return diagonal_; }  ///< one block per node
  const std::vector<Eigen::Matrix3d>& lower() const { return lower_; }  ///< one block per entry of BlockPattern::column
  const std::vector<NodePair>& pairs() const { return pairs_; }         ///< as of the last couple(); empty before it
  const std::vector<Eigen::Matrix3d>& coupled() const { return coupled_; }  ///< of pairs()

 private:
  struct Places {
    std::vector<int> groups, place;
    int group_size;
  };
  int placeOf(int row, int column) const;
  Eigen::Matrix3d& below(int row, int column);

  std::shared_ptr<const BlockPattern> pattern_;
  std::vector<NodePair> pairs_;
  std::vector<Eigen::Matrix3d> diagonal_, lower_, coupled_;
  std::vector<Places> places_;
  std::vector<int> column_start_, column_block_;  // the blocks of each column below the diagonal, for fix()
};

}  // namespace vibe
