#pragma once

namespace vibe {

/// Loops over the rows of dense matrices, stored row after row. No operation is fused and each number is changed in the
/// same order, so that all instruction sets give the same bits.
struct DenseRowKernels {
  /// out -= factor[k] * row k of the matrix, for k = 0 .. rows - 1, one after the other. Factors of 0 are left out.
  void (*subtractRows)(double* out, int columns, const double* matrix, const double* factor, int rows);
  /// A step of an LU factorization of n rows: from the columns behind `to` of the rows from `to` on takes the four rows
  /// before `to`, times the factors that stand in their columns.
  void (*eliminateFour)(double* matrix, int n, int to);
};

/// For the instruction set in use.
DenseRowKernels denseRowKernels();

}  // namespace vibe
