#include "suture/limited_slide.hpp"

#include <algorithm>
#include <limits>

namespace vibe {

namespace {
// Problems solved for one thread. Design choice: the second has nearly always the right segments; those that are still
// missing are found in the next step.
constexpr int kProblems = 4;
// Rounding of a slide [m].
constexpr double kSpareRounding = 1e-10;
}  // namespace

void LimitedSlide::solve(const Eigen::Ref<const Eigen::VectorXd>& residual,
                         const Eigen::Ref<const Eigen::MatrixXd>& compliance,
                         const Eigen::Ref<const Eigen::VectorXd>& capstan_factor,
                         const Eigen::Ref<const Eigen::VectorXd>& spare, ThreadSlide& result) {
  slideThread(residual, compliance, capstan_factor, result);
  count_ = static_cast<int>(residual.size());
  if (count_ < 2) return;
  exhausted_.fill(false);
  lack_ = residual;
  given_.setZero(count_ - 1);
  for (int problem = 1; problem < kProblems && exhaust(spare, result); ++problem) {
    orderSegments(capstan_factor);
    solveOrdered(compliance, result);
  }
}

// Finds the segments that give away more than they have, and takes what they have.
// @returns whether there are any that were not known
bool LimitedSlide::exhaust(const Eigen::Ref<const Eigen::VectorXd>& spare, const ThreadSlide& result) {
  bool found = false;
  for (int k = 0; k < count_; ++k) {
    const double next = k + 1 < count_ ? result.slide[k] : 0, before = k > 0 ? -result.slide[k - 1] : 0;
    if (exhausted_[k] || next + before <= spare[k] + kSpareRounding) continue;
    exhausted_[k] = found = true;
    giveAway(k, spare[k], next > before ? 1 : -1);
  }
  return found;
}

// To the nearest segment in this direction that can take it.
void LimitedSlide::giveAway(int segment, double amount, int direction) {
  int taker = segment + direction;
  while (taker >= 0 && taker < count_ && exhausted_[taker]) taker += direction;
  if (taker < 0 || taker >= count_) return;
  lack_[segment] += amount;
  lack_[taker] -= amount;
  for (int e = std::min(segment, taker); e < std::max(segment, taker); ++e) given_[e] += direction * amount;
}

// Thread passes an exhausted segment as if its two eyelets were one.
void LimitedSlide::orderSegments(const Eigen::Ref<const Eigen::VectorXd>& capstan_factor) {
  factor_.setConstant(count_ - 1, std::numeric_limits<double>::infinity());
  kept_ = 0;
  double product = 1;
  for (int k = 0; k < count_; ++k) {
    if (!exhausted_[k]) {
      if (kept_ > 0) factor_[kept_ - 1] = product;
      order_[kept_++] = k;
      product = 1;
    }
    if (k + 1 < count_) product *= capstan_factor[k];
  }
  int end = kept_;
  for (int k = 0; k < count_; ++k)
    if (exhausted_[k]) order_[end++] = k;
}

void LimitedSlide::solveOrdered(const Eigen::Ref<const Eigen::MatrixXd>& compliance, ThreadSlide& result) {
  ordered_lack_.resize(count_);
  ordered_compliance_.resize(count_, count_);
  for (int i = 0; i < count_; ++i) {
    ordered_lack_[i] = lack_[order_[i]];
    for (int j = 0; j < count_; ++j) ordered_compliance_(i, j) = compliance(order_[i], order_[j]);
  }
  slideThread(ordered_lack_, ordered_compliance_, factor_, ordered_);
  result.converged = ordered_.converged;
  result.slide = given_;
  for (int i = 0; i < count_; ++i) {
    result.tension[order_[i]] = ordered_.tension[i];
    result.slack[order_[i]] = ordered_.slack[i];
    if (i + 1 >= kept_) continue;
    for (int e = order_[i]; e < order_[i + 1]; ++e) result.slide[e] += ordered_.slide[i];
  }
}

}  // namespace vibe
