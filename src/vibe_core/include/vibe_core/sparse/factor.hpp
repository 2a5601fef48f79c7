#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "vibe_core/sparse/block_matrix.hpp"

namespace vibe {

class ThreadPool;

/// Storage precision of a factor. A factor is read twice per solve, and memory traffic dominates the cost.
enum class FactorStorage { Half, Float, Double };

/// The elimination order and the blocks of the factor for one pattern. Constant; created once and shared by many
/// factors. Nested dissection by METIS (fixed seeds: the plan is reproducible), supernodes over the elimination tree.
/// METIS uses rand(): another thread that calls rand() or srand() meanwhile changes the plan.
class FactorPlan;
/// Makes orders from several seeds and takes the one whose factor costs least to solve with.
std::shared_ptr<const FactorPlan> makeFactorPlan(const BlockPattern& pattern);
/// The plan for a pattern with further pairs of nodes: the order of `base`, in which those nodes that the pairs connect
/// across branches of the elimination tree are moved up to where the branches meet. After Zarebavani et al., "Parth",
/// ACM Trans. Graph. 44 (2025). A function of its arguments alone, without METIS, and safe in any thread.
/// @param base   of a pattern without pairs
/// @param pairs  sorted, each once, none in the pattern; empty: the result is `base`
std::shared_ptr<const FactorPlan> coupledPlan(const std::shared_ptr<const FactorPlan>& base,
                                              const std::vector<NodePair>& pairs);
/// The pairs that coupledPlan() was given; empty for a plan of makeFactorPlan().
const std::vector<NodePair>& pairsOf(const FactorPlan& plan);

/// L^-1 times the three unit vectors of a node. It is nonzero only on the path from the node to the root of the
/// elimination tree. Rows are in elimination order, padded to supernodes: one run per supernode on the path, ascending,
/// so that the columns of two nodes share whole runs. Entries before the start of the path are exactly zero.
struct HalfColumns {
  std::vector<std::int32_t> begin;  ///< first row of each contiguous run of rows
  std::vector<std::int32_t> count;  ///< rows in the run
  std::vector<float> value;         ///< runs after one another, 3 interleaved values per row (x, y, z column)
};

/// Cholesky factor L Lt = D A D of a positive definite block matrix, where the diagonal scaling D makes every diagonal
/// entry of the scaled matrix 1. Stored in the requested precision: per supernode as [L11^-1; -L21 L11^-1], with
/// columns scaled to the range of half precision. For storage in half precision it is computed in single precision, and
/// in double precision where a pivot of D A D is below 3e-4; otherwise in double precision. The half-precision factor
/// is still the inverse of some symmetric positive definite matrix, near A^-1 to about 1e-3 if A is well conditioned.
/// It is meant as a preconditioner. The substitutions may run in several threads at once, compute() must run alone.
class Factor {
 public:
  /// Takes the memory that the plan needs. compute() comes next.
  /// @param plan  not null
  explicit Factor(std::shared_ptr<const FactorPlan> plan, FactorStorage storage = FactorStorage::Half);
  ~Factor();
  Factor(const Factor&) = delete;
  Factor& operator=(const Factor&) = delete;

  /// Changes the plan to one of a matrix of the same size, and keeps the memory. compute() comes next.
  void setPlan(std::shared_ptr<const FactorPlan> plan);
  const std::shared_ptr<const FactorPlan>& plan() const { return plan_; }  ///< as constructed, or of the last setPlan()

  /// @returns false if the matrix is not positive definite (a pivot of D A D is below 1e-14, or not a number); the
  ///         factor is then unusable until the next success
  /// @throws Error  if pattern or pairs of the matrix are not those of the plan
  bool compute(const BlockMatrix& matrix);
  /// The same bits by the threads of a pool.
  bool compute(const BlockMatrix& matrix, ThreadPool& pool);

  /// Length of the vectors below: 3 * nodes.
  int rows() const;
  /// Multiplies by D and permutes: nodes as 4 floats (x, y, z, unused) -> elimination order.
  void load(const float* nodes4, float* vector) const;
  /// The inverse permutation of load, followed by multiplication by D.
  void store(const float* vector, float* nodes4) const;
  /// L^-1, in place. load, forward, backward and store together solve A x = b.
  void forward(float* vector) const;
  void backward(float* vector) const;  ///< L^-T, in place
  /// The same bits by the threads of a pool, which share the elimination tree and the rows of its root.
  void forward(float* vector, ThreadPool& pool) const;
  void backward(float* vector, ThreadPool& pool) const;  ///< like forward() by threads
  /// Complete solve with arithmetic and storage in double precision; slow, for checks. Interleaved (3 * nodes).
  /// @throws Error  if the storage is not FactorStorage::Double
  void solve(const double* b, double* x) const;
  /// L^-1 D e for the three unit vectors e of `node`.
  void halfColumns(int node, HalfColumns& out) const;

  std::int64_t nonzeros() const;  ///< of L

 private:
  struct Storage;
  void checkPattern(const BlockMatrix& matrix) const;

  std::shared_ptr<const FactorPlan> plan_;
  std::unique_ptr<Storage> storage_;
};

}  // namespace vibe
