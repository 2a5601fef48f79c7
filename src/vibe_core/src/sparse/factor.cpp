#include "vibe_core/sparse/factor.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>
#include <vector>

#include "sparse/aligned_buffer.hpp"
#include "sparse/factor_plan.hpp"
#include "sparse/multifrontal.hpp"
#include "threads/lending_pool.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/threads/thread_pool.hpp"

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

std::atomic<int>* countersOfThread(std::size_t count) {
  thread_local std::vector<std::atomic<int>> counters;
  if (counters.size() < count) counters = std::vector<std::atomic<int>>(count);
  return counters.data();
}

// What others have recorded for its rows.
void receive(const FactorPlan& plan, const FactorPlan::Task& task, const float* records, float* vector) {
  for (int r = task.received; r < task.received + task.receipts; ++r) {
    const FactorPlan::Receipt& receipt = plan.receipts[r];
    const std::int32_t* const row = plan.row_index.data() + receipt.index;
    const float* record = records + receipt.record;
    for (int i = 0; i < receipt.nodes; ++i, record += 3)
      for (int a = 0; a < 3; ++a) vector[row[i] + a] += record[a];
  }
}

// The root is divided into parts of the same size, of rows 0 to n of a triangle, or of columns. Design choice: as many
// as a shell has shares.
constexpr int kRootParts = 4;
BlockRange rowsOfPart(int part, int blocks) {
  const auto end = [=](int k) { return static_cast<int>(std::lround(blocks * std::sqrt(k / double{kRootParts}))); };
  return {end(part), end(part + 1)};
}
BlockRange tilesOfPart(int part, int blocks) {
  const BlockRange mirrored = rowsOfPart(kRootParts - 1 - part, blocks);
  return {blocks - mirrored.last, blocks - mirrored.first};
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

  void forward(float* vector, ThreadPool& pool) const {
    float* const records = recordOfThread(plan->record_size);
    std::atomic<int>* const waits = countersOfThread(plan->tasks.size());
    for (std::size_t t = 0; t < plan->tasks.size(); ++t)
      waits[t].store(plan->tasks[t].children, std::memory_order_relaxed);
    pool.parallelFor(static_cast<int>(plan->tasks.size()), 1, [=](int t, int) {
      const FactorPlan::Task& task = plan->tasks[t];
      ThreadPool::await(waits[t]);
      receive(*plan, task, records, vector);
      PanelSet part = partOf(panels(), task.first, task.last);
      part.end_row = task.end_row;
      part.record = records + task.record;
      kernels.forward(part, vector, workOfThread<float>(workSize(*plan)));
      if (task.parent != -1) waits[task.parent].fetch_sub(1, std::memory_order_acq_rel);
    });
    if (plan->root.first == plan->root.last) return;
    receive(*plan, plan->root, records, vector);
    const PanelStep& step = plan->steps[plan->root.first];
    float *const own = vector + step.first_row, *const work = workOfThread<float>(workSize(*plan));
    pool.parallelFor(kRootParts, 1, [=, &step](int k, int) {
      kernels.forwardRows(panels(), plan->root.first, rowsOfPart(k, step.row_blocks), own, work);
    });
    std::copy_n(work, step.columns, own);
  }

  void backward(float* vector, ThreadPool& pool) const {
    if (plan->root.first != plan->root.last) backwardInRoot(vector, pool);
    std::atomic<int>* const busy = countersOfThread(plan->tasks.size());
    for (std::size_t t = 0; t < plan->tasks.size(); ++t) busy[t].store(1, std::memory_order_relaxed);
    pool.parallelFor(static_cast<int>(plan->tasks.size()), 1, [=](int k, int) {
      const int t = plan->backward[k];
      const FactorPlan::Task& task = plan->tasks[t];
      if (task.parent != -1) ThreadPool::await(busy[task.parent]);
      kernels.backward(partOf(panels(), task.first, task.last), vector, workOfThread<float>(workSize(*plan)));
      busy[t].store(0, std::memory_order_release);
    });
  }

  void backwardInRoot(float* vector, ThreadPool& pool) const {
    const PanelStep& step = plan->steps[plan->root.first];
    float* const work = workOfThread<float>(workSize(*plan));
    std::fill(std::copy_n(vector + step.first_row, step.columns, work), work + step.row_blocks * kTile, 0.0F);
    pool.parallelFor(kRootParts, 1, [=, &step](int k, int) {
      kernels.backwardTiles(panels(), plan->root.first, tilesOfPart(k, step.row_blocks), work, vector);
    });
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
  pool.threads() == 1 ? forward(vector) : storage_->forward(vector, pool);
}

void Factor::backward(float* vector, ThreadPool& pool) const {
  pool.threads() == 1 ? backward(vector) : storage_->backward(vector, pool);
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
