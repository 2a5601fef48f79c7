#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "sparse/block_matrix.hpp"

namespace vibe {

/// How the numbers of a factor are kept: it is read twice per solve and memory traffic is the cost.
enum class FactorStorage { Half, Float, Double };

/// The order of elimination and the blocks of the factor for one pattern. Constant; made once, used by many factors.
/// Nested dissection by METIS (fixed seeds: the same plan every time), supernodes over the elimination tree.
/// METIS draws from rand(): another thread that calls rand() or srand() meanwhile changes the plan.
class FactorPlan;
std::shared_ptr<const FactorPlan> makeFactorPlan(const BlockPattern& pattern);

/// L^-1 times the three unit vectors of a node: nonzero only on the node's path to the root of the elimination tree.
/// Rows in elimination order, padded to supernodes: one run per supernode on the path, ascending, so that the columns
/// of two nodes share whole runs. Exact zeros where the path has not begun.
struct HalfColumns {
  std::vector<std::int32_t> begin;  ///< first row of each contiguous run of rows
  std::vector<std::int32_t> count;  ///< rows in the run
  std::vector<float> value;         ///< runs after one another, 3 interleaved values per row (x, y, z column)
};

/// Cholesky factor L Lt = D A D of a positive definite block matrix, D the diagonal scaling that makes every diagonal
/// entry of the scaled matrix 1. Computed in double, stored as asked: per supernode as [L11^-1; -L21 L11^-1], whose
/// columns are scaled to the range of a half. What half precision stores is still the inverse of some symmetric
/// positive definite matrix, near A^-1 to about 1e-3 where A is well conditioned: a preconditioner. The substitutions
/// may run in several threads at once, compute() only alone.
class Factor {
 public:
  explicit Factor(std::shared_ptr<const FactorPlan> plan, FactorStorage storage = FactorStorage::Half);
  ~Factor();
  Factor(const Factor&) = delete;
  Factor& operator=(const Factor&) = delete;

  /// @returns false where the matrix is not positive definite (a pivot of D A D is below 1e-14, or not a number); the
  /// factor is then unusable until the next success
  /// @throws Error  the matrix has another pattern than the plan
  bool compute(const BlockMatrix& matrix);

  /// Length of the vectors below: 3 * nodes.
  int rows() const;
  /// Multiplies by D and permutes: nodes as 4 floats (x, y, z, unused) -> elimination order.
  void load(const float* nodes4, float* vector) const;
  /// The reverse of load, and D again.
  void store(const float* vector, float* nodes4) const;
  /// In place; L^-1 and L^-T. forward then backward on a loaded vector, then store, solves A x = b.
  void forward(float* vector) const;
  void backward(float* vector) const;
  /// Whole solve in double precision of arithmetic and storage, for checks: slow. Interleaved (3 * nodes).
  /// @throws Error  the storage is not FactorStorage::Double
  void solve(const double* b, double* x) const;
  /// L^-1 D e for the three unit vectors e of `node`.
  void halfColumns(int node, HalfColumns& out) const;

  std::int64_t nonzeros() const;  ///< of L

 private:
  struct Storage;
  std::shared_ptr<const FactorPlan> plan_;
  std::unique_ptr<Storage> storage_;
};

}  // namespace vibe
