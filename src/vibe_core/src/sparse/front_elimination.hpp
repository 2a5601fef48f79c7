#pragma once

#include "sparse/aligned_buffer.hpp"
#include "sparse/panel_kernel.hpp"
#include "vibe_core/threads/thread_pool.hpp"

namespace vibe {

/// Eliminates the first columns of a dense symmetric matrix ("front", lower triangle, column-major) in place. They
/// become W of PanelStep, [ L11^-1 ; -L21 L11^-1 ], and the rest becomes the Schur complement. Works on blocks of
/// kBlock columns: finished columns hold W up to this point, so that one product updates both W and the rest of the
/// front.
/// @tparam Real  float or double
template <class Real>
class FrontElimination {
 public:
  static constexpr int kBlock = 48;  // a multiple of the register tile in both directions

  /// Column stride and total size of a front with this many rows. Tiles extend beyond the last row and column.
  static std::int64_t stride(std::int64_t rows) {
    return (rows + kDenseRows<Real> - 1) / kDenseRows<Real> * kDenseRows<Real> + kDenseRows<Real>;
  }
  static std::int64_t size(std::int64_t rows) { return stride(rows) * (rows + kDenseColumns); }

  FrontElimination();
  /// Makes room for fronts of so many rows.
  void setLargestFront(int rows);
  /// @param pool  shares the columns; the bits do not depend on it
  /// @returns false if a pivot is not positive (for a matrix with a unit diagonal: not above rounding)
  bool run(Real* front, int rows, int columns, ThreadPool& pool);

 private:
  bool factorDiagonal(int first, int width);
  void finishOwnRows(int first, int width);
  void eliminateBelow(int first, int width);
  void packBelow(int first, int width);
  void packRest(int first, int width);
  void packOwn(int first, int width);
  void updateRest(int first, int width);
  Real* at(int row, int column) { return front_ + column * stride_ + row; }

  DenseUpdate<Real> update_;
  AlignedBuffer<Real> below_;  // rows under the block, as A of DenseUpdate
  AlignedBuffer<Real> own_;    // their factors, for every column of the front, as B
  AlignedBuffer<Real> negative_inverse_a_, negative_inverse_b_;
  AlignedBuffer<Real> lower_, inverse_;  // of the diagonal block, kBlock numbers from column to column
  ThreadPool* pool_ = nullptr;
  Real* front_ = nullptr;
  std::int64_t stride_ = 0;
  int rows_ = 0;
};

}  // namespace vibe
