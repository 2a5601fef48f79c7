#pragma once

#include "arithmetic/multiply_add.hpp"
#include "sparse/panel_kernel.hpp"

namespace vibe {
namespace {

template <class Real, class Arch>
struct DenseKernel {
  using Pack = xsimd::batch<Real, Arch>;
  static constexpr int kWidth = static_cast<int>(Pack::size);
  static constexpr int kParts = 2;  // 2 x 6 sums, 2 numbers of A and one of B fit into 16 registers

  static void tile(const Real* a, const Real* b, int depth, Real* c, std::int64_t stride) {
    Pack sum[kDenseColumns][kParts];
    for (auto& column : sum)
      for (Pack& part : column) part = Pack(Real(0));
    for (int k = 0; k < depth; ++k, a += kDenseRows<Real>, b += kDenseColumns) {
      Pack row[kParts];
      for (int i = 0; i < kParts; ++i) row[i] = Pack::load_aligned(a + i * kWidth);
      for (int j = 0; j < kDenseColumns; ++j) {
        const Pack factor(b[j]);
        for (int i = 0; i < kParts; ++i) sum[j][i] = mulAdd(row[i], factor, sum[j][i]);
      }
    }
    for (int j = 0; j < kDenseColumns; ++j)
      for (int i = 0; i < kParts; ++i) {
        Real* to = c + j * stride + i * kWidth;
        (Pack::load_unaligned(to) - sum[j][i]).store_unaligned(to);
      }
  }

  static void update(const Real* a, int row_panels, const Real* b, int depth, Real* c, std::int64_t stride) {
    for (int panel = 0; panel < row_panels; ++panel, a += depth * kDenseRows<Real>, c += kDenseRows<Real>)
      for (int row = 0; row < kDenseRows<Real>; row += kParts * kWidth) tile(a + row, b, depth, c + row, stride);
  }
};

}  // namespace

DenseUpdate<float> VIBE_KERNEL(floatUpdate)() {
  return DenseKernel<float, KernelSets::VIBE_KERNEL_SET>::update;
}

DenseUpdate<double> VIBE_KERNEL(doubleUpdate)() {
  return DenseKernel<double, KernelSets::VIBE_KERNEL_SET>::update;
}

}  // namespace vibe
