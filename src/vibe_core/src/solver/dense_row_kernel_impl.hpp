#pragma once
#include <cstddef>

#include "arithmetic/kernel_path.hpp"
#include "arithmetic/unfused_sets.hpp"
#include "solver/dense_row_kernel.hpp"

namespace vibe {
namespace {

template <class Arch>
struct DenseRows {
  using Pack = xsimd::batch<double, Arch>;
  static constexpr int kWidth = static_cast<int>(Pack::size);
  static constexpr int kTogether = 4;  // rows, for which a number is read and written once

  static Pack load(const double* p) { return Pack::load_unaligned(p); }

  template <int kRows>
  static void subtract(double* out, int columns, const double* const* row, const double* factor) {
    Pack f[kRows];
    for (int r = 0; r < kRows; ++r) f[r] = Pack(factor[r]);
    int i = 0;
    for (; i + kWidth <= columns; i += kWidth) {
      Pack left = load(out + i);
      for (int r = 0; r < kRows; ++r) left -= f[r] * load(row[r] + i);
      left.store_unaligned(out + i);
    }
    for (; i < columns; ++i)
      for (int r = 0; r < kRows; ++r) out[i] -= factor[r] * row[r][i];
  }

  static void subtractRows(double* out, int columns, const double* matrix, const double* factor, int rows) {
    const double* row[kTogether];
    double used[kTogether];
    int count = 0;
    for (int k = 0; k < rows; ++k) {
      if (factor[k] == 0) continue;
      row[count] = matrix + static_cast<std::size_t>(k) * static_cast<std::size_t>(columns);
      used[count++] = factor[k];
      if (count < kTogether) continue;
      subtract<kTogether>(out, columns, row, used);
      count = 0;
    }
    for (int k = 0; k < count; ++k) subtract<1>(out, columns, row + k, used + k);
  }

  // of kRows rows, for which the four are read once
  template <int kRows>
  static void eliminateFrom(const double* four, double* matrix, int n, int to, int first) {
    const auto size = static_cast<std::size_t>(n);
    double* row[kRows];
    Pack f[kRows][4];
    for (int r = 0; r < kRows; ++r) {
      row[r] = matrix + static_cast<std::size_t>(first + r) * size;
      for (int p = 0; p < 4; ++p) f[r][p] = Pack(row[r][to - 4 + p]);
    }
    const double *const a = four, *const b = a + size, *const c = b + size, *const d = c + size;
    int j = to;
    for (; j + kWidth <= n; j += kWidth) {
      const Pack pa = load(a + j), pb = load(b + j), pc = load(c + j), pd = load(d + j);
      for (int r = 0; r < kRows; ++r)
        (load(row[r] + j) - ((f[r][0] * pa + f[r][1] * pb) + (f[r][2] * pc + f[r][3] * pd)))
            .store_unaligned(row[r] + j);
    }
    for (; j < n; ++j)
      for (int r = 0; r < kRows; ++r) {
        const double* const g = row[r] + to - 4;
        row[r][j] -= (g[0] * a[j] + g[1] * b[j]) + (g[2] * c[j] + g[3] * d[j]);
      }
  }

  static void eliminateFour(double* matrix, int n, int to) {
    const double* const four = matrix + static_cast<std::size_t>(to - 4) * static_cast<std::size_t>(n);
    int i = to;
    for (; i + 2 <= n; i += 2) eliminateFrom<2>(four, matrix, n, to, i);
    if (i < n) eliminateFrom<1>(four, matrix, n, to, i);
  }
};

}  // namespace

DenseRowKernels VIBE_KERNEL(denseRowKernels)() {
  using Rows = DenseRows<UnfusedSets::VIBE_KERNEL_SET>;
  return {Rows::subtractRows, Rows::eliminateFour};
}

}  // namespace vibe
