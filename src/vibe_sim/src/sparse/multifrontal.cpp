#include "multifrontal.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

namespace vibe {
namespace {

// of a matrix with a unit diagonal: below it a pivot is nothing but rounding
constexpr double kSmallestPivot = 1e-14;

using Matrix = Eigen::Map<Eigen::MatrixXd, Eigen::Unaligned, Eigen::OuterStride<>>;

}  // namespace

Multifrontal::Multifrontal(const FactorPlan& plan) : plan_(plan) {
  std::int64_t front = 0, panel = 0;
  for (std::size_t s = 0; s < plan.steps.size(); ++s) {
    const std::int64_t rows = stride(static_cast<int>(s));
    front = std::max(front, rows * rows);
    panel = std::max(panel, rows * plan.steps[s].columns);
  }
  front_.resize(front);
  panel_.resize(panel);
  stack_.resize(plan.stack_size);
  waiting_.reserve(plan.steps.size());
}

void Multifrontal::assemble(int s, const BlockMatrix& matrix, const std::vector<double>& scale) {
  const FactorPlan::Front& front = plan_.fronts[s];
  const std::int64_t rows = stride(s);
  for (std::int64_t j = 0; j < rows; ++j)
    std::fill(front_.begin() + j * rows + j, front_.begin() + (j + 1) * rows, 0.0);
  for (int i = 0; i < front.entry_count; ++i) addEntry(plan_.entries[front.first_entry + i], s, matrix, scale);
  for (int i = 0; i < front.child_count; ++i) {
    addUpdate(waiting_.back(), static_cast<int>(rows));
    stack_top_ = waiting_.back().begin;
    waiting_.pop_back();
  }
}

int Multifrontal::rowOfFront(int s, int row) const {
  const PanelStep& step = plan_.steps[s];
  if (row < step.columns) return step.first_row + row;
  return plan_.row_index[step.first_index + (row - step.columns) / 3];
}

void Multifrontal::addEntry(const FactorPlan::Entry& entry, int s, const BlockMatrix& matrix,
                            const std::vector<double>& scale) {
  const Eigen::Matrix3d& block = entry.block < 0 ? matrix.diagonal()[-1 - entry.block] : matrix.lower()[entry.block];
  const double* row_scale = scale.data() + rowOfFront(s, entry.row);
  const double* column_scale = scale.data() + rowOfFront(s, entry.column);
  for (int j = 0; j < 3; ++j) {
    double* column = front_.data() + static_cast<std::int64_t>(entry.column + j) * stride(s) + entry.row;
    for (int i = 0; i < 3; ++i)
      column[i] += (entry.transposed ? block(j, i) : block(i, j)) * row_scale[i] * column_scale[j];
  }
}

void Multifrontal::addUpdate(const Update& update, int front_stride) {
  const FactorPlan::Front& child = plan_.fronts[update.supernode];
  const int rows = 3 * plan_.steps[update.supernode].below_nodes;
  const FactorPlan::Run* runs = plan_.runs.data() + child.first_run;
  for (int a = 0; a < child.run_count; ++a)
    for (int j = 0; j < runs[a].count; ++j) {
      const double* from = stack_.data() + update.begin + static_cast<std::int64_t>(runs[a].from + j) * rows;
      double* to = front_.data() + static_cast<std::int64_t>(runs[a].to + j) * front_stride;
      for (int i = j; i < runs[a].count; ++i) to[runs[a].to + i] += from[runs[a].from + i];
      for (int b = a + 1; b < child.run_count; ++b)
        for (int i = 0; i < runs[b].count; ++i) to[runs[b].to + i] += from[runs[b].from + i];
    }
}

bool Multifrontal::eliminate(int s) {
  const PanelStep& step = plan_.steps[s];
  const int columns = step.columns, below = 3 * step.below_nodes, rows = stride(s);
  Matrix front(front_.data(), rows, rows, Eigen::OuterStride<>(rows));
  Matrix panel(panel_.data(), rows, columns, Eigen::OuterStride<>(rows));
  auto pivots = front.topLeftCorner(columns, columns);
  Eigen::LLT<Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>>> factor(pivots);
  if (factor.info() != Eigen::Success) return false;
  for (int i = 0; i < columns; ++i)
    if (!(pivots(i, i) * pivots(i, i) > kSmallestPivot)) return false;

  panel.setZero();
  auto inverse = panel.topRows(columns);
  inverse.setIdentity();
  pivots.triangularView<Eigen::Lower>().solveInPlace(inverse);
  if (below == 0) return true;
  auto lower = front.block(columns, 0, below, columns);
  pivots.triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(lower);
  front.block(columns, columns, below, below).selfadjointView<Eigen::Lower>().rankUpdate(lower, -1.0);
  panel.middleRows(columns, below).noalias() = -lower * inverse.triangularView<Eigen::Lower>();
  return true;
}

void Multifrontal::pushUpdate(int s) {
  const PanelStep& step = plan_.steps[s];
  const std::int64_t rows = 3 * step.below_nodes, front_stride = stride(s);
  for (std::int64_t j = 0; j < rows; ++j) {
    const double* from = front_.data() + (step.columns + j) * front_stride + step.columns;
    std::copy(from + j, from + rows, stack_.begin() + stack_top_ + j * rows + j);
  }
  waiting_.push_back({s, stack_top_});
  stack_top_ += rows * rows;
}

}  // namespace vibe
