#include "sparse/multifrontal.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

namespace vibe {

namespace {

// numbers above the diagonal that register tiles still access
template <class Real>
constexpr int kDiagonal = 2 * kDenseRows<Real>;
// Of a front in one piece of work. Design choice: in a front of a thousand rows, ten microseconds.
constexpr int kColumns = 32;
constexpr int kTiles = kColumns / kTile;

}  // namespace

template <class Real>
void Multifrontal<Real>::setPlan(const FactorPlan& plan) {
  plan_ = &plan;
  stack_.grow(plan.stack_size);
}

template <class Real>
int Multifrontal<Real>::rows(int s) const {
  return plan_->steps[s].columns + 3 * plan_->steps[s].below_nodes;
}

template <class Real>
void Multifrontal<Real>::assemble(int s, const BlockMatrix& matrix, const std::vector<double>& scale, Worker& worker,
                                  ThreadPool& pool) {
  const FactorPlan::Front& front = plan_->fronts[s];
  Real* const numbers = worker.front.data();
  const std::int64_t stride = FrontElimination<Real>::stride(rows(s));
  pool.parallelFor(rows(s), kColumns, [=](int begin, int end) {
    for (std::int64_t j = begin; j < end; ++j) {
      const std::int64_t first = std::max<std::int64_t>(0, j - kDiagonal<Real>);
      std::fill(numbers + j * stride + first, numbers + (j + 1) * stride, Real(0));
    }
  });
  for (int i = 0; i < front.entry_count; ++i)
    addEntry(plan_->entries[front.first_entry + i], s, matrix, scale, numbers);
  for (int i = 0; i < front.child_count; ++i) {
    const Update update = worker.waiting.back();
    addUpdate(update, stride, numbers, pool);
    if (update.begin < worker.stack_top) worker.stack_top = update.begin;  // else it is a branch's
    worker.waiting.pop_back();
  }
}

template <class Real>
int Multifrontal<Real>::rowOfFront(int s, int row) const {
  const PanelStep& step = plan_->steps[s];
  if (row < step.columns) return step.first_row + row;
  return plan_->row_index[step.first_index + (row - step.columns) / 3];
}

template <class Real>
void Multifrontal<Real>::addEntry(const FactorPlan::Entry& entry, int s, const BlockMatrix& matrix,
                                  const std::vector<double>& scale, Real* front) const {
  const int known = static_cast<int>(matrix.lower().size());
  const Eigen::Matrix3d& block = entry.block < 0       ? matrix.diagonal()[-1 - entry.block]
                                 : entry.block < known ? matrix.lower()[entry.block]
                                                       : matrix.coupled()[entry.block - known];
  const double* row_scale = scale.data() + rowOfFront(s, entry.row);
  const double* column_scale = scale.data() + rowOfFront(s, entry.column);
  for (int j = 0; j < 3; ++j) {
    Real* column =
        front + static_cast<std::int64_t>(entry.column + j) * FrontElimination<Real>::stride(rows(s)) + entry.row;
    for (int i = 0; i < 3; ++i)
      column[i] += static_cast<Real>((entry.transposed ? block(j, i) : block(i, j)) * row_scale[i] * column_scale[j]);
  }
}

template <class Real>
void Multifrontal<Real>::addUpdate(const Update& update, std::int64_t front_stride, Real* front,
                                   ThreadPool& pool) const {
  const FactorPlan::Front& child = plan_->fronts[update.supernode];
  const int rows = 3 * plan_->steps[update.supernode].below_nodes;
  const FactorPlan::Run* const runs = plan_->runs.data() + child.first_run;
  const Real* const numbers = stack_.data() + update.begin;
  pool.parallelFor(rows, kColumns, [=, &child](int begin, int end) {
    const auto after = [](int column, const FactorPlan::Run& run) { return column < run.from; };
    int a = static_cast<int>(std::upper_bound(runs, runs + child.run_count, begin, after) - runs) - 1;
    for (int column = begin; column < end; ++column) {
      if (column == runs[a].from + runs[a].count) ++a;
      addColumn(child, a, column, numbers + static_cast<std::int64_t>(column) * rows,
                front + (runs[a].to + column - runs[a].from) * front_stride);
    }
  });
}

// The rows of a column from the diagonal on.
template <class Real>
void Multifrontal<Real>::addColumn(const FactorPlan::Front& child, int run, int column, const Real* from,
                                   Real* to) const {
  const FactorPlan::Run* const runs = plan_->runs.data() + child.first_run;
  for (int i = column - runs[run].from; i < runs[run].count; ++i) to[runs[run].to + i] += from[runs[run].from + i];
  for (int b = run + 1; b < child.run_count; ++b)
    for (int i = 0; i < runs[b].count; ++i) to[runs[b].to + i] += from[runs[b].from + i];
}

template <class Real>
void Multifrontal<Real>::pushUpdate(int s, Worker& worker, ThreadPool& pool) {
  const PanelStep& step = plan_->steps[s];
  const std::int64_t count = 3 * step.below_nodes, front_stride = FrontElimination<Real>::stride(rows(s));
  const Real* const front = worker.front.data() + step.columns * front_stride + step.columns;
  Real* const update = stack_.data() + worker.stack_top;
  pool.parallelFor(static_cast<int>(count), kColumns, [=](int begin, int end) {
    for (std::int64_t j = begin; j < end; ++j)
      std::copy(front + j * front_stride + j, front + j * front_stride + count, update + j * count + j);
  });
  worker.waiting.push_back({s, worker.stack_top});
  worker.stack_top += count * count;
}

template class Multifrontal<float>;
template class Multifrontal<double>;

namespace {

std::uint32_t bits(float value) {
  std::uint32_t result = 0;
  std::memcpy(&result, &value, sizeof(result));
  return result;
}

constexpr std::uint32_t kSmallestNormalHalf = 113U << 23;  // 2^-14, as the bits of a float
constexpr int kLargestExponent = 14;  // scaled columns reach at most 2^14: a quarter of the range of a half

// rounds to nearest even; for values below 2^15, with subnormal results flushed to zero, so that no branch is needed
std::uint16_t toHalf(float value) {
  const std::uint32_t magnitude = bits(value) & 0x7fffffffU;
  const std::uint32_t rounded = magnitude + 0xfffU + (magnitude >> 13 & 1U);
  const std::uint32_t half = (rounded >> 13) - (112U << 10) + (bits(value) >> 16 & 0x8000U);
  return static_cast<std::uint16_t>(magnitude < kSmallestNormalHalf ? 0U : half);
}

/// One column of a panel during the conversion from double to the storage format. The loops are written for
/// auto-vectorisation.
template <class Number>
struct Column {
  std::vector<Number> numbers;

  template <class Real>
  float take(const Real* from, int count) {
    numbers.resize(count);
    for (int i = 0; i < count; ++i) numbers[i] = static_cast<Number>(from[i]);
    return 1;
  }
};

template <>
struct Column<std::uint16_t> {
  std::vector<std::uint16_t> numbers;
  std::vector<float> rounded;

  // The scale is a power of two, so scaling is exact. It prevents overflow of the column, and the loss by flushing
  // subnormals is less than 2^-27 of the largest number in the column.
  template <class Real>
  float take(const Real* from, int count) {
    numbers.resize(count);
    rounded.resize(count);
    float* single = rounded.data();
    for (int i = 0; i < count; ++i) single[i] = static_cast<float>(from[i]);
    std::int32_t largest = 0;  // the bit patterns of positive floats are ordered like their values
    for (int i = 0; i < count; ++i)
      largest = std::max(largest, static_cast<std::int32_t>(bits(single[i]) & 0x7fffffffU));
    const int exponent = (largest >> 23) - 127 + 1 - kLargestExponent;
    const float scale = std::ldexp(1.0F, exponent), factor = std::ldexp(1.0F, -exponent);
    std::uint16_t* half = numbers.data();
    for (int i = 0; i < count; ++i) half[i] = toHalf(single[i] * factor);
    return scale;
  }
};

}  // namespace

template <class Real, class Number>
void packPanel(const FrontPanel<Real>& panel, const PanelStep& step, Number* to, float* column_scale,
               ThreadPool& pool) {
  const int rows = step.row_blocks * kTile;
  pool.parallelFor((step.columns + kTile - 1) / kTile, kTiles, [=, &panel, &step](int begin, int end) {
    thread_local Column<Number> column;
    for (int first = begin * kTile; first < std::min(end * kTile, step.columns); first += kTile) {
      const int width = std::min(kTile, step.columns - first);
      for (int j = 0; j < width; ++j) {
        column_scale[first + j] = column.take(panel.numbers + (first + j) * panel.stride + first, rows - first);
        const Number* from = column.numbers.data();
        Number* block = to + panelSize(first, step.row_blocks) + j * kTile;
        for (int row = first; row < rows; row += kTile, from += kTile, block += width * kTile)
          std::memcpy(block, from, kTile * sizeof(Number));
      }
    }
  });
}

template void packPanel(const FrontPanel<float>&, const PanelStep&, std::uint16_t*, float*, ThreadPool&);
template void packPanel(const FrontPanel<double>&, const PanelStep&, std::uint16_t*, float*, ThreadPool&);
template void packPanel(const FrontPanel<double>&, const PanelStep&, float*, float*, ThreadPool&);
template void packPanel(const FrontPanel<double>&, const PanelStep&, double*, float*, ThreadPool&);

}  // namespace vibe
