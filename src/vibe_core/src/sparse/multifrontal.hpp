#pragma once

#include <cstdint>
#include <vector>

#include "sparse/aligned_buffer.hpp"
#include "sparse/factor_plan.hpp"
#include "sparse/front_elimination.hpp"

namespace vibe {

/// Panel of one supernode as produced by the factorisation: W of PanelStep, column-major with column stride `stride`,
/// zero above the diagonal and below the last row.
template <class Real>
struct FrontPanel {
  const Real* numbers;
  std::int64_t stride;
};

/// Multifrontal Cholesky factorisation (Duff and Reid, ACM Trans. Math. Softw. 9 (1983)) of a sequence of matrices.
/// Keeps its memory between them.
/// @tparam Real  of the arithmetic, float or double
template <class Real>
class Multifrontal {
 public:
  /// What follows is about this plan, which must outlive its use.
  void setPlan(const FactorPlan& plan);

  /// Factors D A D and passes the panel of every supernode to `take(supernode, panel)`, in ascending order.
  /// @param scale  D, by row in elimination order
  /// @returns false if a pivot is not positive: the matrix is numerically not positive definite
  template <class Take>
  bool run(const BlockMatrix& matrix, const std::vector<double>& scale, const Take& take) {
    stack_top_ = 0;
    waiting_.clear();
    for (int s = 0; s < static_cast<int>(plan_->steps.size()); ++s) {
      assemble(s, matrix, scale);
      if (!elimination_.run(front_.data(), rows(s), plan_->steps[s].columns)) return false;
      take(s, FrontPanel<Real>{front_.data(), FrontElimination<Real>::stride(rows(s))});
      pushUpdate(s);
    }
    return true;
  }

 private:
  struct Update {
    int supernode;
    std::int64_t begin;
  };

  int rows(int s) const;  // of the front
  void assemble(int s, const BlockMatrix& matrix, const std::vector<double>& scale);
  void addEntry(const FactorPlan::Entry& entry, int s, const BlockMatrix& matrix, const std::vector<double>& scale);
  int rowOfFront(int s, int row) const;
  void addUpdate(const Update& update, std::int64_t front_stride);
  void pushUpdate(int s);

  const FactorPlan* plan_ = nullptr;
  FrontElimination<Real> elimination_;
  AlignedBuffer<Real> front_, stack_;
  std::vector<Update> waiting_;
  std::int64_t stack_top_ = 0;
};

/// Writes a panel in the order of PanelStep; column_scale gets one number per column. Halves are IEEE 754 binary16
/// without subnormal numbers, which some processors convert slowly; these become zero.
template <class Real, class Number>
void packPanel(const FrontPanel<Real>& panel, const PanelStep& step, Number* to, float* column_scale);

}  // namespace vibe
