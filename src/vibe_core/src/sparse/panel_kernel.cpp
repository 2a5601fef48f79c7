#include "sparse/panel_kernel.hpp"

#include <algorithm>
#include <type_traits>

namespace vibe {

PanelKernels halfKernelsSse2();
PanelKernels halfKernelsFusedSse2();
PanelKernels halfKernelsAvx2();
PanelKernels floatKernelsSse2();
PanelKernels floatKernelsFusedSse2();
PanelKernels floatKernelsAvx2();

PanelKernels halfKernels(KernelPath path) {
  if (path == KernelPath::Plain) return halfKernelsSse2();
  return path == KernelPath::FusedSse2 ? halfKernelsFusedSse2() : halfKernelsAvx2();
}

PanelKernels floatKernels(KernelPath path) {
  if (path == KernelPath::Plain) return floatKernelsSse2();
  return path == KernelPath::FusedSse2 ? floatKernelsFusedSse2() : floatKernelsAvx2();
}

namespace {

/// Kernels for panels in double without vector instructions; for checks, not for speed.
struct PlainKernel {
  // calls visit(column, first row of a block, its 8 numbers) for the whole panel
  template <class Visit>
  static void forEachColumn(const PanelSet& set, const PanelStep& step, const Visit& visit) {
    const double* p = static_cast<const double*>(set.numbers) + step.panel;
    for (int first = 0; first < step.columns; first += kTile)
      for (int block = first / kTile; block < step.row_blocks; ++block)
        for (int column = first; column < std::min(first + kTile, step.columns); ++column, p += kTile)
          visit(column, block * kTile, p);
  }

  // @returns where the next step records
  template <class Real>
  static Real* forwardStep(const PanelSet& set, const PanelStep& step, Real* vector, int stride, Real* work,
                           Real* record) {
    std::fill(work, work + step.row_blocks * kTile, Real(0));
    Real* own = vector + step.first_row * stride;
    forEachColumn(set, step, [&](int column, int row, const double* number) {
      for (int i = 0; i < kTile; ++i) work[row + i] += static_cast<Real>(number[i]) * own[column * stride];
    });
    for (int i = 0; i < step.columns; ++i) own[i * stride] = work[i];
    const Real* update = work + step.columns;
    for (int i = 0; i < step.below_nodes; ++i) {
      const std::int32_t row = set.row_index[step.first_index + i];
      for (int a = 0; a < 3; ++a, ++update)
        if (row < set.end_row)
          vector[(row + a) * stride] += *update;
        else
          *record++ = *update;
    }
    return record;
  }

  template <class Real>
  static void backwardStep(const PanelSet& set, const PanelStep& step, Real* vector, Real* work) {
    Real* own = vector + step.first_row;
    std::fill(std::copy(own, own + step.columns, work), work + step.row_blocks * kTile, Real(0));
    Real* below = work + step.columns;
    for (int i = 0; i < step.below_nodes; ++i)
      for (int a = 0; a < 3; ++a) *below++ = vector[set.row_index[step.first_index + i] + a];
    std::fill(own, own + step.columns, Real(0));
    forEachColumn(set, step, [&](int column, int row, const double* number) {
      for (int i = 0; i < kTile; ++i) own[column] += static_cast<Real>(number[i]) * work[row + i];
    });
  }

  template <class Real>
  static void forward(const PanelSet& set, Real* vector, Real* work) {
    Real* record = nullptr;
    if constexpr (std::is_same_v<Real, float>) record = set.record;
    for (int s = 0; s < set.step_count; ++s) record = forwardStep(set, set.steps[s], vector, 1, work, record);
  }

  template <class Real>
  static void backward(const PanelSet& set, Real* vector, Real* work) {
    for (int s = set.step_count - 1; s >= 0; --s) backwardStep(set, set.steps[s], vector, work);
  }

  static void forwardRows(const PanelSet& set, int step, BlockRange rows, const float* own, float* work) {
    std::fill(work + rows.first * kTile, work + rows.last * kTile, 0.0F);
    forEachColumn(set, set.steps[step], [&](int column, int row, const double* number) {
      if (row < rows.first * kTile || row >= rows.last * kTile) return;
      for (int i = 0; i < kTile; ++i) work[row + i] += static_cast<float>(number[i]) * own[column];
    });
  }

  static void backwardTiles(const PanelSet& set, int step, BlockRange tiles, const float* work, float* vector) {
    float* const own = vector + set.steps[step].first_row;
    const int first = tiles.first * kTile, last = std::min(tiles.last * kTile, set.steps[step].columns);
    std::fill(own + first, own + last, 0.0F);
    forEachColumn(set, set.steps[step], [&](int column, int row, const double* number) {
      if (column < first || column >= last) return;
      for (int i = 0; i < kTile; ++i) own[column] += static_cast<float>(number[i]) * work[row + i];
    });
  }

  static void stepOfThree(const PanelSet& set, int step, int, float* vectors, float* work) {
    for (int k = 0; k < 3; ++k) forwardStep<float>(set, set.steps[step], vectors + k, 3, work, nullptr);
  }
};

}  // namespace

PanelKernels doubleKernels() {
  return {PlainKernel::forward<float>, PlainKernel::backward<float>, PlainKernel::stepOfThree, PlainKernel::forwardRows,
          PlainKernel::backwardTiles};
}

void solveDouble(const PanelSet& set, double* vector, double* work) {
  PlainKernel::forward(set, vector, work);
  PlainKernel::backward(set, vector, work);
}

DenseUpdate<float> floatUpdateSse2();
DenseUpdate<float> floatUpdateFusedSse2();
DenseUpdate<float> floatUpdateAvx2();
DenseUpdate<double> doubleUpdateSse2();
DenseUpdate<double> doubleUpdateFusedSse2();
DenseUpdate<double> doubleUpdateAvx2();

template <>
DenseUpdate<float> denseUpdate(KernelPath path) {
  if (path == KernelPath::Plain) return floatUpdateSse2();
  return path == KernelPath::FusedSse2 ? floatUpdateFusedSse2() : floatUpdateAvx2();
}

template <>
DenseUpdate<double> denseUpdate(KernelPath path) {
  if (path == KernelPath::Plain) return doubleUpdateSse2();
  return path == KernelPath::FusedSse2 ? doubleUpdateFusedSse2() : doubleUpdateAvx2();
}

}  // namespace vibe
