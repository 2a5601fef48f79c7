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

}  // namespace

template <class Real>
void Multifrontal<Real>::setPlan(const FactorPlan& plan) {
  plan_ = &plan;
  elimination_.setLargestFront(plan.largest_front);
  front_.grow(FrontElimination<Real>::size(plan.largest_front));
  stack_.grow(plan.stack_size);
  waiting_.reserve(plan.steps.size());
}

template <class Real>
int Multifrontal<Real>::rows(int s) const {
  return plan_->steps[s].columns + 3 * plan_->steps[s].below_nodes;
}

template <class Real>
void Multifrontal<Real>::assemble(int s, const BlockMatrix& matrix, const std::vector<double>& scale) {
  const FactorPlan::Front& front = plan_->fronts[s];
  const std::int64_t stride = FrontElimination<Real>::stride(rows(s));
  for (std::int64_t j = 0; j < rows(s); ++j) {
    const std::int64_t first = std::max<std::int64_t>(0, j - kDiagonal<Real>);
    std::fill(front_.data() + j * stride + first, front_.data() + (j + 1) * stride, Real(0));
  }
  for (int i = 0; i < front.entry_count; ++i) addEntry(plan_->entries[front.first_entry + i], s, matrix, scale);
  for (int i = 0; i < front.child_count; ++i) {
    addUpdate(waiting_.back(), stride);
    stack_top_ = waiting_.back().begin;
    waiting_.pop_back();
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
                                  const std::vector<double>& scale) {
  const int known = static_cast<int>(matrix.lower().size());
  const Eigen::Matrix3d& block = entry.block < 0       ? matrix.diagonal()[-1 - entry.block]
                                 : entry.block < known ? matrix.lower()[entry.block]
                                                       : matrix.coupled()[entry.block - known];
  const double* row_scale = scale.data() + rowOfFront(s, entry.row);
  const double* column_scale = scale.data() + rowOfFront(s, entry.column);
  for (int j = 0; j < 3; ++j) {
    Real* column = front_.data() +
                   static_cast<std::int64_t>(entry.column + j) * FrontElimination<Real>::stride(rows(s)) + entry.row;
    for (int i = 0; i < 3; ++i)
      column[i] += static_cast<Real>((entry.transposed ? block(j, i) : block(i, j)) * row_scale[i] * column_scale[j]);
  }
}

template <class Real>
void Multifrontal<Real>::addUpdate(const Update& update, std::int64_t front_stride) {
  const FactorPlan::Front& child = plan_->fronts[update.supernode];
  const int rows = 3 * plan_->steps[update.supernode].below_nodes;
  const FactorPlan::Run* runs = plan_->runs.data() + child.first_run;
  for (int a = 0; a < child.run_count; ++a)
    for (int j = 0; j < runs[a].count; ++j) {
      const Real* from = stack_.data() + update.begin + static_cast<std::int64_t>(runs[a].from + j) * rows;
      Real* to = front_.data() + (runs[a].to + j) * front_stride;
      for (int i = j; i < runs[a].count; ++i) to[runs[a].to + i] += from[runs[a].from + i];
      for (int b = a + 1; b < child.run_count; ++b)
        for (int i = 0; i < runs[b].count; ++i) to[runs[b].to + i] += from[runs[b].from + i];
    }
}

template <class Real>
void Multifrontal<Real>::pushUpdate(int s) {
  const PanelStep& step = plan_->steps[s];
  const std::int64_t count = 3 * step.below_nodes, front_stride = FrontElimination<Real>::stride(rows(s));
  for (std::int64_t j = 0; j < count; ++j) {
    const Real* from = front_.data() + (step.columns + j) * front_stride + step.columns;
    std::copy(from + j, from + count, stack_.data() + stack_top_ + j * count + j);
  }
  waiting_.push_back({s, stack_top_});
  stack_top_ += count * count;
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
void packPanel(const FrontPanel<Real>& panel, const PanelStep& step, Number* to, float* column_scale) {
  thread_local Column<Number> column;
  const int rows = step.row_blocks * kTile;
  for (int first = 0; first < step.columns; first += kTile) {
    const int width = std::min(kTile, step.columns - first);
    for (int j = 0; j < width; ++j) {
      column_scale[first + j] = column.take(panel.numbers + (first + j) * panel.stride + first, rows - first);
      const Number* from = column.numbers.data();
      Number* block = to + j * kTile;
      for (int row = first; row < rows; row += kTile, from += kTile, block += width * kTile)
        std::memcpy(block, from, kTile * sizeof(Number));
    }
    to += width * (rows - first);
  }
}

template void packPanel(const FrontPanel<float>&, const PanelStep&, std::uint16_t*, float*);
template void packPanel(const FrontPanel<double>&, const PanelStep&, std::uint16_t*, float*);
template void packPanel(const FrontPanel<double>&, const PanelStep&, float*, float*);
template void packPanel(const FrontPanel<double>&, const PanelStep&, double*, float*);

}  // namespace vibe
