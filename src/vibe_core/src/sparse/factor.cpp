#include "vibe_core/sparse/factor.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "common/lending_pool.hpp"
#include "sparse/aligned_buffer.hpp"
#include "sparse/factor_plan.hpp"
#include "sparse/multifrontal.hpp"
#include "vibe_core/common/error.hpp"
#include "vibe_core/common/thread_pool.hpp"

namespace vibe {
namespace {

constexpr std::int64_t kLargeFactor = 16 << 20;  // bytes

// several threads may solve with one factor at the same time
template <class Number>
Number* workOfThread(std::int64_t count) {
  thread_local AlignedBuffer<Number> buffer;
  if (buffer.size() < count) buffer.resize(count);
  return buffer.data();
}

float* recordOfThread(std::int64_t count) {
  thread_local AlignedBuffer<float> buffer;
  if (buffer.size() < count) buffer.resize(count);
  return buffer.data();
}

PanelSet partOf(PanelSet set, int first, int last) {
  set.steps += first;
  set.step_count = last - first;
  return set;
}

// What a branch has recorded.
void addRecord(const FactorPlan& plan, const FactorPlan::Branch& branch, const float* record, float* vector) {
  record += branch.record;
  for (int s = branch.first; s < branch.last; ++s) {
    const std::int32_t* const begin = plan.row_index.data() + plan.steps[s].first_index;
    const std::int32_t* const end = begin + plan.steps[s].below_nodes;
    for (const std::int32_t* row = std::lower_bound(begin, end, branch.end_row); row < end; ++row, record += 3)
      for (int a = 0; a < 3; ++a) vector[*row + a] += record[a];
  }
}

std::int64_t workSize(const FactorPlan& plan) {
  return plan.largest_front + kTile;
}

PanelKernels kernelsFor(FactorStorage storage) {
  switch (storage) {
    case FactorStorage::Half:
      return halfKernels(kernelPath());
    case FactorStorage::Float:
      return floatKernels(kernelPath());
    default:
      return doubleKernels();
  }
}

}  // namespace

struct Factor::Storage {
  explicit Storage(FactorStorage storage) : kind(storage), kernels(kernelsFor(storage)) {}

  void setPlan(std::shared_ptr<const FactorPlan> wanted) {
    plan = std::move(wanted);
    const std::size_t rows = 3 * static_cast<std::size_t>(plan->pattern->size);
    scale.resize(rows);
    float_scale.resize(rows);
    column_scale.resize(rows);
    if (kind == FactorStorage::Half) half.grow(plan->panel_size);
    if (kind == FactorStorage::Float) single.grow(plan->panel_size);
    if (kind == FactorStorage::Double) wide.grow(plan->panel_size);
  }

  const void* numbers() const {
    if (kind == FactorStorage::Half) return half.data();
    if (kind == FactorStorage::Float) return single.data();
    return wide.data();
  }

  PanelSet panels() const {
    return {plan->steps.data(),     static_cast<int>(plan->steps.size()),
            plan->row_index.data(), numbers(),
            column_scale.data(),    ahead()};
  }

  // measured: panels in the last-level cache need a shorter prefetch distance than those in memory
  std::ptrdiff_t ahead() const {
    const std::int64_t bytes = plan->panel_size * (kind == FactorStorage::Half    ? 2
                                                   : kind == FactorStorage::Float ? 4
                                                                                  : 8);
    return bytes < kLargeFactor ? 8192 : 16384;
  }

  bool takeScale(const BlockMatrix& matrix) {
    for (int k = 0; k < plan->pattern->size; ++k)
      for (int a = 0; a < 3; ++a) {
        const double entry = matrix.diagonal()[plan->order[k]](a, a);
        if (!(entry > 0) || !std::isfinite(entry)) return false;
        scale[3 * k + a] = 1 / std::sqrt(entry);
        float_scale[3 * k + a] = static_cast<float>(scale[3 * k + a]);
      }
    return true;
  }

  template <class Visit>
  void inBranches(ThreadPool& pool, const Visit& visit) const {
    pool.parallelFor(static_cast<int>(plan->branches.size()), 1,
                     [&visit, this](int b, int) { visit(plan->branches[static_cast<std::size_t>(b)]); });
  }
  void runForward(int first, int last, float* vector) const {
    kernels.forward(partOf(panels(), first, last), vector, workOfThread<float>(workSize(*plan)));
  }
  void runBackward(int first, int last, float* vector) const {
    kernels.backward(partOf(panels(), first, last), vector, workOfThread<float>(workSize(*plan)));
  }

  void take(int s, const FrontPanel<float>& panel, ThreadPool& pool) { pack(s, panel, half, pool); }
  void take(int s, const FrontPanel<double>& panel, ThreadPool& pool) {
    if (kind == FactorStorage::Half) pack(s, panel, half, pool);
    if (kind == FactorStorage::Float) pack(s, panel, single, pool);
    if (kind == FactorStorage::Double) pack(s, panel, wide, pool);
  }

  template <class Real, class Number>
  void pack(int s, const FrontPanel<Real>& panel, AlignedBuffer<Number>& numbers, ThreadPool& pool) {
    const PanelStep& step = plan->steps[s];
    packPanel(panel, step, numbers.data() + step.panel, column_scale.data() + step.first_row, pool);
  }

  bool compute(const BlockMatrix& matrix, ThreadPool& pool) {
    if (!takeScale(matrix)) return false;
    return (kind == FactorStorage::Half && eliminate<float>(matrix, pool)) || eliminate<double>(matrix, pool);
  }

  // the fronts take more memory than the factor
  template <class Real>
  bool eliminate(const BlockMatrix& matrix, ThreadPool& pool) {
    const typename LendingPool<Multifrontal<Real>>::Loan elimination;
    elimination->setPlan(*plan);
    const auto taking = [this](int s, const auto& panel, ThreadPool& threads) { this->take(s, panel, threads); };
    return elimination->run(matrix, scale, taking, pool);
  }

  std::shared_ptr<const FactorPlan> plan;
  FactorStorage kind;
  PanelKernels kernels;
  std::vector<double> scale;  // D, in elimination order
  std::vector<float> float_scale, column_scale;
  AlignedBuffer<std::uint16_t> half;
  AlignedBuffer<float> single;
  AlignedBuffer<double> wide;
};

Factor::Factor(std::shared_ptr<const FactorPlan> plan, FactorStorage storage)
    : storage_(std::make_unique<Storage>(storage)) {
  setPlan(std::move(plan));
}

Factor::~Factor() = default;

void Factor::setPlan(std::shared_ptr<const FactorPlan> plan) {
  plan_ = std::move(plan);
  storage_->setPlan(plan_);
}

void Factor::checkPattern(const BlockMatrix& matrix) const {
  const BlockPattern &given = matrix.pattern(), &known = *plan_->pattern;
  if (given.size == known.size && given.start == known.start && given.column == known.column &&
      matrix.pairs() == plan_->pairs)
    return;
  throw Error("a matrix of " + std::to_string(given.size) + " nodes and " +
              std::to_string(given.column.size() + matrix.pairs().size()) +
              " blocks does not have the pattern of its factor's plan (" + std::to_string(known.size) + " nodes, " +
              std::to_string(known.column.size() + plan_->pairs.size()) + " blocks): make the plan from its pattern.");
}

bool Factor::compute(const BlockMatrix& matrix) {
  ThreadPool single;
  return compute(matrix, single);
}

bool Factor::compute(const BlockMatrix& matrix, ThreadPool& pool) {
  checkPattern(matrix);
  return storage_->compute(matrix, pool);
}

int Factor::rows() const {
  return 3 * plan_->pattern->size;
}

void Factor::load(const float* nodes4, float* vector) const {
  const float* scale = storage_->float_scale.data();
  for (const int node : plan_->order) {
    for (int a = 0; a < 3; ++a) vector[a] = scale[a] * nodes4[4 * node + a];
    vector += 3;
    scale += 3;
  }
}

void Factor::store(const float* vector, float* nodes4) const {
  const float* scale = storage_->float_scale.data();
  for (const int node : plan_->order) {
    for (int a = 0; a < 3; ++a) nodes4[4 * node + a] = scale[a] * vector[a];
    nodes4[4 * node + 3] = 0;
    vector += 3;
    scale += 3;
  }
}

void Factor::forward(float* vector) const {
  storage_->kernels.forward(storage_->panels(), vector, workOfThread<float>(workSize(*plan_)));
}

void Factor::backward(float* vector) const {
  storage_->kernels.backward(storage_->panels(), vector, workOfThread<float>(workSize(*plan_)));
}

void Factor::forward(float* vector, ThreadPool& pool) const {
  if (pool.threads() == 1) return forward(vector);
  float* const record = recordOfThread(plan_->record_size);
  storage_->inBranches(pool, [&](const FactorPlan::Branch& branch) {
    PanelSet part = partOf(storage_->panels(), branch.first, branch.last);
    part.end_row = branch.end_row;
    part.record = record + branch.record;
    storage_->kernels.forward(part, vector, workOfThread<float>(workSize(*plan_)));
  });
  int next = 0;
  for (const FactorPlan::Branch& branch : plan_->branches) {
    storage_->runForward(next, branch.first, vector);
    addRecord(*plan_, branch, record, vector);
    next = branch.last;
  }
  storage_->runForward(next, static_cast<int>(plan_->steps.size()), vector);
}

void Factor::backward(float* vector, ThreadPool& pool) const {
  if (pool.threads() == 1) return backward(vector);
  int next = static_cast<int>(plan_->steps.size());
  for (auto branch = plan_->branches.rbegin(); branch != plan_->branches.rend(); ++branch) {
    storage_->runBackward(branch->last, next, vector);
    next = branch->first;
  }
  storage_->runBackward(0, next, vector);
  storage_->inBranches(
      pool, [&](const FactorPlan::Branch& branch) { storage_->runBackward(branch.first, branch.last, vector); });
}

void Factor::solve(const double* b, double* x) const {
  if (storage_->kind != FactorStorage::Double)
    throw Error(
        "a factor stored in half or single precision cannot solve in double: make it with "
        "FactorStorage::Double.");
  double* vector = workOfThread<double>(rows() + kTile + workSize(*plan_));
  for (int k = 0; k < plan_->pattern->size; ++k)
    for (int a = 0; a < 3; ++a) vector[3 * k + a] = storage_->scale[3 * k + a] * b[3 * plan_->order[k] + a];
  solveDouble(storage_->panels(), vector, vector + rows() + kTile);
  for (int k = 0; k < plan_->pattern->size; ++k)
    for (int a = 0; a < 3; ++a) x[3 * plan_->order[k] + a] = storage_->scale[3 * k + a] * vector[3 * k + a];
}

void Factor::halfColumns(int node, HalfColumns& out) const {
  const int row = 3 * plan_->position[node];
  const std::int64_t vector_size = (3 * rows() + kTile) / kTile * kTile;
  float* vectors = workOfThread<float>(vector_size + 3 * workSize(*plan_));
  out.begin.clear();
  out.count.clear();
  for (int s = plan_->holder[plan_->position[node]]; s != -1; s = plan_->fronts[s].parent) {
    const PanelStep& step = plan_->steps[s];
    out.begin.push_back(step.first_row);
    out.count.push_back(step.columns);
    std::fill_n(vectors + 3 * step.first_row, 3 * step.columns, 0.0F);
  }
  for (int a = 0; a < 3; ++a) vectors[3 * (row + a) + a] = storage_->float_scale[row + a];
  out.value.clear();
  int from = row - out.begin.front();
  for (int s = plan_->holder[plan_->position[node]]; s != -1; s = plan_->fronts[s].parent) {
    const PanelStep& step = plan_->steps[s];
    storage_->kernels.stepOfThree(storage_->panels(), s, from, vectors, vectors + vector_size);
    from = 0;
    const float* own = vectors + 3 * step.first_row;
    out.value.insert(out.value.end(), own, own + 3 * step.columns);
  }
}

std::int64_t Factor::nonzeros() const {
  return plan_->nonzeros;
}

}  // namespace vibe
