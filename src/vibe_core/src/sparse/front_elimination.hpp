#pragma once

#include "sparse/aligned_buffer.hpp"
#include "sparse/dense_kernel.hpp"

namespace vibe {

/// Eliminates the first columns of a dense symmetric matrix ("front", lower triangle, column-major) in place. They
/// become W of PanelStep, [ L11^-1 ; -L21 L11^-1 ], and the rest becomes the Schur complement. Blocks of kBlock columns
/// at a time: the columns that are done hold W so far, so that one product updates W and the rest of the front alike.
class FrontElimination {
 public:
  static constexpr int kBlock = 48;  // whole register tiles both ways

  /// Numbers from column to column of a front of so many rows, and numbers in all: tiles reach beyond the last row and
  /// column.
  static std::int64_t stride(std::int64_t rows) {
    return (rows + kDenseRows - 1) / kDenseRows * kDenseRows + kDenseRows;
  }
  static std::int64_t size(std::int64_t rows) { return stride(rows) * (rows + kDenseColumns); }

  explicit FrontElimination(int largest_front);
  /// @returns false where a pivot is not positive (of a matrix with a unit diagonal: above rounding)
  bool run(double* front, int rows, int columns);

 private:
  bool factorDiagonal(int first, int width);
  void finishOwnRows(int first, int width);
  void eliminateBelow(int first, int width);
  void packBelow(int first, int width);
  void packOwn(int first, int width);
  void updateRest(int first, int width);
  double* at(int row, int column) { return front_ + column * stride_ + row; }

  DenseUpdate update_;
  AlignedBuffer<double> below_;  // rows under the block, as A of DenseUpdate
  AlignedBuffer<double> own_;    // what multiplies them, for every column of the front, as B
  AlignedBuffer<double> negative_inverse_a_, negative_inverse_b_;
  AlignedBuffer<double> lower_, inverse_;  // of the diagonal block, kBlock numbers from column to column
  double* front_ = nullptr;
  std::int64_t stride_ = 0;
  int rows_ = 0;
};

}  // namespace vibe
