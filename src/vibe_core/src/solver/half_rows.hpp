#pragma once

#include <Eigen/Core>
#include <vector>

#include "solver/column_cache.hpp"

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
  /// Values of the rows of a half-solved vector.
  void values(const ColumnCache& cache, const float* y, Eigen::VectorXd& out);
  /// Adds the rows' forces to a half-solved vector.
  void addForces(const ColumnCache& cache, const Eigen::VectorXd& force, float* y);
  /// Compliance between the rows, with their own (rows x rows) [m/N].
  void compliances(Eigen::MatrixXd& out);

 private:
  int end(int row) const { return row + 1 < count() ? first_[static_cast<std::size_t>(row) + 1] : terms(); }
  int terms() const { return static_cast<int>(slot_.size()); }
  void formGram(ColumnCache& cache);

  std::vector<int> first_;  // term of each row
  std::vector<double> compliance_;
  std::vector<int> slot_;                     // of each term
  std::vector<int> place_;                    // of each term: index into used_
  std::vector<Eigen::Vector3d> coefficient_;  // of each term
  std::vector<int> used_;                     // slots, by key
  std::vector<int> place_of_slot_;
  std::vector<double> gram_;            // between used slots (3 used x 3 used)
  std::vector<double> given_;           // gram times a row
  std::vector<Eigen::Vector3f> share_;  // per used slot: of a vector or of the forces
};

}  // namespace vibe
