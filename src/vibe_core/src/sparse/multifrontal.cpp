#include "sparse/multifrontal.hpp"

#include <algorithm>

namespace vibe {
namespace {

constexpr int kDiagonal = 16;  // numbers above the diagonal that register tiles still access

}  // namespace

void Multifrontal::setPlan(const FactorPlan& plan) {
  plan_ = &plan;
  elimination_.setLargestFront(plan.largest_front);
  front_.grow(FrontElimination::size(plan.largest_front));
  stack_.grow(plan.stack_size);
  waiting_.reserve(plan.steps.size());
}

int Multifrontal::rows(int s) const {
  return plan_->steps[s].columns + 3 * plan_->steps[s].below_nodes;
}

void Multifrontal::assemble(int s, const BlockMatrix& matrix, const std::vector<double>& scale) {
  const FactorPlan::Front& front = plan_->fronts[s];
  const std::int64_t stride = FrontElimination::stride(rows(s));
  for (std::int64_t j = 0; j < rows(s); ++j) {
    const std::int64_t first = std::max<std::int64_t>(0, j - kDiagonal);
    std::fill(front_.data() + j * stride + first, front_.data() + (j + 1) * stride, 0.0);
  }
  for (int i = 0; i < front.entry_count; ++i) addEntry(plan_->entries[front.first_entry + i], s, matrix, scale);
  for (int i = 0; i < front.child_count; ++i) {
    addUpdate(waiting_.back(), stride);
    stack_top_ = waiting_.back().begin;
    waiting_.pop_back();
  }
}

int Multifrontal::rowOfFront(int s, int row) const {
  const PanelStep& step = plan_->steps[s];
  if (row < step.columns) return step.first_row + row;
  return plan_->row_index[step.first_index + (row - step.columns) / 3];
}

void Multifrontal::addEntry(const FactorPlan::Entry& entry, int s, const BlockMatrix& matrix,
                            const std::vector<double>& scale) {
  const int known = static_cast<int>(matrix.lower().size());
  const Eigen::Matrix3d& block = entry.block < 0       ? matrix.diagonal()[-1 - entry.block]
                                 : entry.block < known ? matrix.lower()[entry.block]
                                                       : matrix.coupled()[entry.block - known];
  const double* row_scale = scale.data() + rowOfFront(s, entry.row);
  const double* column_scale = scale.data() + rowOfFront(s, entry.column);
  for (int j = 0; j < 3; ++j) {
    double* column =
        front_.data() + static_cast<std::int64_t>(entry.column + j) * FrontElimination::stride(rows(s)) + entry.row;
    for (int i = 0; i < 3; ++i)
      column[i] += (entry.transposed ? block(j, i) : block(i, j)) * row_scale[i] * column_scale[j];
  }
}

void Multifrontal::addUpdate(const Update& update, std::int64_t front_stride) {
  const FactorPlan::Front& child = plan_->fronts[update.supernode];
  const int rows = 3 * plan_->steps[update.supernode].below_nodes;
  const FactorPlan::Run* runs = plan_->runs.data() + child.first_run;
  for (int a = 0; a < child.run_count; ++a)
    for (int j = 0; j < runs[a].count; ++j) {
      const double* from = stack_.data() + update.begin + static_cast<std::int64_t>(runs[a].from + j) * rows;
      double* to = front_.data() + (runs[a].to + j) * front_stride;
      for (int i = j; i < runs[a].count; ++i) to[runs[a].to + i] += from[runs[a].from + i];
      for (int b = a + 1; b < child.run_count; ++b)
        for (int i = 0; i < runs[b].count; ++i) to[runs[b].to + i] += from[runs[b].from + i];
    }
}

void Multifrontal::pushUpdate(int s) {
  const PanelStep& step = plan_->steps[s];
  const std::int64_t count = 3 * step.below_nodes, front_stride = FrontElimination::stride(rows(s));
  for (std::int64_t j = 0; j < count; ++j) {
    const double* from = front_.data() + (step.columns + j) * front_stride + step.columns;
    std::copy(from + j, from + count, stack_.data() + stack_top_ + j * count + j);
  }
  waiting_.push_back({s, stack_top_});
  stack_top_ += count * count;
}

}  // namespace vibe
