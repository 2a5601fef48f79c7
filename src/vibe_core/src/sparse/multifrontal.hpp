#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "sparse/aligned_buffer.hpp"
#include "sparse/factor_plan.hpp"
#include "sparse/front_elimination.hpp"
#include "threads/lending_pool.hpp"
#include "vibe_core/threads/thread_pool.hpp"

namespace vibe {

/// Panel of one supernode as produced by the factorisation: W of PanelStep, column-major with column stride `stride`,
/// zero above the diagonal and below the last row.
template <class Real>
struct FrontPanel {
  const Real* numbers;
  std::int64_t stride;
};

/// Multifrontal Cholesky factorisation (Duff and Reid, ACM Trans. Math. Softw. 9 (1983)) of a sequence of matrices.
/// Keeps its memory between them. Threads take branches of the elimination tree, then columns of the trunk's fronts; a
/// number is the result of the same operations in the same order for any number of them.
/// @tparam Real  of the arithmetic, float or double
template <class Real>
class Multifrontal {
 public:
  /// What follows is about this plan, which must outlive its use.
  void setPlan(const FactorPlan& plan);

  /// Factors D A D and passes the panel of every supernode to `take(supernode, panel, pool)`, several at once.
  /// @param scale  D, by row in elimination order
  /// @returns false if a pivot is not positive: the matrix is numerically not positive definite
  template <class Take>
  bool run(const BlockMatrix& matrix, const std::vector<double>& scale, const Take& take, ThreadPool& pool) {
    std::atomic<bool> positive{true};
    const auto eliminate = [&](int first, int last, Worker& worker, ThreadPool& threads) {
      for (int s = first; s < last && positive; ++s) {
        assemble(s, matrix, scale, worker, threads);
        if (!worker.elimination.run(worker.front.data(), rows(s), plan_->steps[s].columns, threads)) {
          positive = false;
          return;
        }
        take(s, FrontPanel<Real>{worker.front.data(), FrontElimination<Real>::stride(rows(s))}, threads);
        pushUpdate(s, worker, threads);
      }
    };
    pool.parallelFor(static_cast<int>(plan_->branches.size()), 1, [&](int b, int) {
      const FactorPlan::Branch& branch = plan_->branches[static_cast<std::size_t>(b)];
      const typename LendingPool<Worker>::Loan worker;
      worker->begin(branch.largest_front, branch.stack);
      eliminate(branch.first, branch.last, *worker, worker->single);
    });
    const typename LendingPool<Worker>::Loan worker;
    worker->begin(plan_->largest_front, 0);
    int next = 0;
    for (const FactorPlan::Branch& branch : plan_->branches) {
      eliminate(next, branch.first, *worker, pool);
      worker->waiting.push_back({branch.last - 1, branch.stack});
      next = branch.last;
    }
    eliminate(next, static_cast<int>(plan_->steps.size()), *worker, pool);
    return positive;
  }

 private:
  struct Update {
    int supernode;
    std::int64_t begin;
  };
  /// What one branch, or the trunk, needs.
  struct Worker {
    void begin(int largest_front, std::int64_t stack) {
      elimination.setLargestFront(largest_front);
      front.grow(FrontElimination<Real>::size(largest_front));
      waiting.clear();
      stack_top = stack;
    }
    FrontElimination<Real> elimination;
    AlignedBuffer<Real> front;
    std::vector<Update> waiting;
    std::int64_t stack_top = 0;
    ThreadPool single;
  };

  int rows(int s) const;  // of the front
  void assemble(int s, const BlockMatrix& matrix, const std::vector<double>& scale, Worker& worker, ThreadPool& pool);
  void addEntry(const FactorPlan::Entry& entry, int s, const BlockMatrix& matrix, const std::vector<double>& scale,
                Real* front) const;
  int rowOfFront(int s, int row) const;
  void addUpdate(const Update& update, std::int64_t front_stride, Real* front, ThreadPool& pool) const;
  void addColumn(const FactorPlan::Front& child, int run, int column, const Real* from, Real* to) const;
  void pushUpdate(int s, Worker& worker, ThreadPool& pool);

  const FactorPlan* plan_ = nullptr;
  AlignedBuffer<Real> stack_;
};

/// Writes a panel in the order of PanelStep; column_scale gets one number per column. Halves are IEEE 754 binary16
/// without subnormal numbers, which some processors convert slowly; these become zero.
template <class Real, class Number>
void packPanel(const FrontPanel<Real>& panel, const PanelStep& step, Number* to, float* column_scale, ThreadPool& pool);

}  // namespace vibe
