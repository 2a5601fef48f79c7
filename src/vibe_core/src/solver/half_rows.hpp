#pragma once

#include <vector>

#include <Eigen/Core>

#include "solver/column_cache.hpp"
#include "solver/dense_row_kernel.hpp"
#include "solver/half_columns.hpp"

namespace vibe {

/// Rows of constraints in half-solved space: linear functions of the nodes and attachment points in a column cache.
/// Keeps its memory.
class HalfRows {
 public:
  void clear();
  /// Begins another row. One that gets no term has no effect.
  void addRow(double compliance);
  /// Adds coefficient . x at a slot of the cache to the last row.
  void addTerm(int slot, const Eigen::Vector3d& coefficient);
  /// The rows are complete.
  void finish(ColumnCache& cache);

  int count() const { return static_cast<int>(first_.size()); }
  double compliance(int row) const { return compliance_[static_cast<std::size_t>(row)]; }
  /// Values of the rows of a half-solved vector: multiply() for every piece, in any order or at the same time.
  int pieces() const { return (static_cast<int>(used_.size()) + kPiece - 1) / kPiece; }
  void multiply(const ColumnCache& cache, int piece, const float* y);
  void values(Eigen::VectorXd& out) const;
  /// The rows' forces on a half-solved vector, then what they add to some of its rows.
  void setForces(const Eigen::VectorXd& force);
  void addForces(const ColumnCache& cache, RowRange rows, float* y) const;
  /// Ranges of a half-solved vector to which about as much is added; they do not depend on threads.
  static constexpr int kParts = 3;
  RowRange part(const ColumnCache& cache, int part, int rows) const;
  /// Compliance between the rows, with their own (rows x rows) [m/N].
  void compliances(Eigen::MatrixXd& out);

 private:
  int end(int row) const { return row + 1 < count() ? first_[static_cast<std::size_t>(row) + 1] : terms(); }
  int terms() const { return static_cast<int>(slot_.size()); }
  void formGram(ColumnCache& cache);

  static constexpr int kPiece = 2 * kProducts;  // slots that one thread multiplies by in a row
  DenseRowKernels kernels_ = denseRowKernels();
  std::vector<int> first_;  // term of each row
  std::vector<double> compliance_;
  std::vector<int> slot_;                     // of each term
  std::vector<int> index_;                    // of each term: index into used_
  std::vector<Eigen::Vector3d> coefficient_;  // of each term
  std::vector<int> used_;                     // slots, by key
  std::vector<int> index_of_slot_;
  std::vector<double> gram_;                 // between used slots (3 used x 3 used)
  std::vector<double> row_gram_;             // gram times a row
  std::vector<Eigen::Vector3f> slot_value_;  // per used slot: of a vector or of the forces
};

}  // namespace vibe
