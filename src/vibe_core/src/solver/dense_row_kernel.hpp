#pragma once

namespace vibe {

/// Loops over the rows of dense matrices, stored row after row. No operation is fused and each number is changed in the
/// same order, so that all instruction sets give the same bits.
struct DenseRowKernels {
  /// out -= factor[k] * row k, for k = 0 .. rows - 1, one after the other. Factors of 0 are left out.
  /// @param out     columns numbers
  /// @param matrix  rows x columns numbers
  /// @param factor  rows numbers
  void (*subtractRows)(double* out, int columns, const double* matrix, const double* factor, int rows);
  /// A step of an LU factorization in place: from the rows and columns from `to` on takes the four rows before `to`,
  /// times the factors that stand in the four columns before `to`.
  /// @param matrix  n x n numbers
  void (*eliminateFour)(double* matrix, int n, int to);
};

/// For the instruction set in use.
DenseRowKernels denseRowKernels();

}  // namespace vibe
