#include "suture/thread_run.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/ordered_algebra.hpp"
#include "common/ordered_lu.hpp"

namespace vibe::detail {

namespace {

/// Rates of change below this fraction of the largest one are rounding errors.
constexpr double kResidualRounding = 1e-13;

bool slides(Eyelet eyelet) {
  return eyelet != Eyelet::Sticks;
}

/// Numbers the groups of tight segments that slide into each other, and computes the tension of each segment relative
/// to that of the first of its group. Group -1: not tight.
int groupSegments(const SegmentVector& factor, const Eyelets& eyelets, const Tight& tight,
                  std::array<int, kMaxThreadSegments>& group, SegmentVector& ratio) {
  int count = 0;
  for (int k = 0; k < ratio.size(); ++k) {
    group[k] = -1;
    ratio[k] = 0;
    if (!tight[k]) continue;
    ratio[k] = 1;
    if (k > 0 && tight[k - 1] && slides(eyelets[k - 1])) {
      group[k] = group[k - 1];
      if (eyelets[k - 1] == Eyelet::Forward) ratio[k] = ratio[k - 1] * factor[k - 1];
      if (eyelets[k - 1] == Eyelet::Backward) ratio[k] = ratio[k - 1] / factor[k - 1];
      if (eyelets[k - 1] == Eyelet::Smooth) ratio[k] = ratio[k - 1];
    } else {
      group[k] = count++;
    }
  }
  return count;
}

/// One condition that must stay 0 or more along the path.
struct LinearConstraint {
  int eyelet = -1;
  Eyelet change = Eyelet::Sticks;  ///< new state of the eyelet when the condition reaches 0
  double value = 0, rate = 0;      ///< here, and per t
  double rounding = 0;             ///< smaller rates are insignificant
};

class Path {
 public:
  Path(const SegmentMatrix& compliance, const SegmentVector& residual, const SegmentVector& factor, Eyelets& eyelets)
      : compliance_(compliance), factor_(factor), eyelets_(eyelets) {
    const int m = static_cast<int>(residual.size());
    const double even = residual.sum() / compliance.sum();
    residual_.resize(m, 2);
    sumRows(compliance, residual_.col(0));
    residual_.col(0) *= even;
    residual_.col(1) = residual - residual_.col(0);
    residual_scale_ = residual_.cwiseAbs().maxCoeff();
    tight_.fill(true);
    for (int k = 0; k + 1 < m; ++k) eyelets_[k] = factor[k] < kSmoothFactor ? Eyelet::Smooth : Eyelet::Sticks;
  }

  bool update() {
    const int m = static_cast<int>(residual_.rows());
    LinearConstraint changed;  // none yet
    for (int change = 0; change < 20 * m + 20; ++change) {
      if (!solveLinked(compliance_, residual_, factor_, eyelets_, tight_, tension_, slide_)) return false;
      if (changed.eyelet >= 0) turnIfNeeded(changed);
      LinearConstraint next;
      const double step = nextChange(changed, next);
      if (direction_ > 0 && place_ + step >= 1) {
        place_ = 1;
        return true;
      }
      if (next.eyelet < 0) return false;  // back past the start: no solution on this path
      place_ += direction_ * step;
      const Eyelet before = eyelets_[next.eyelet];
      eyelets_[next.eyelet] = next.change;
      changed = next;
      changed.change = before;  // reaching that again at once would be a rounding error
    }
    return false;
  }

  void here(SegmentVector& tension, SegmentVector& slide) const {
    tension = tension_.col(0) + place_ * tension_.col(1);
    slide = slide_.col(0) + place_ * slide_.col(1);
  }

 private:
  /// Bound on a sticking eyelet before it starts to slide in that direction, or on a slide before it sticks.
  LinearConstraint condition(int k, Eyelet change) const {
    LinearConstraint c;
    c.eyelet = k;
    c.change = change;
    double base = 0;
    if (change == Eyelet::Sticks) {
      const double sign = eyelets_[k] == Eyelet::Forward ? 1 : -1;
      base = sign * slide_(k, 0);
      c.rate = sign * slide_(k, 1);
      c.rounding = kResidualRounding * residual_scale_;
    } else {
      const int less = change == Eyelet::Forward ? k : k + 1, more = change == Eyelet::Forward ? k + 1 : k;
      base = factor_[k] * tension_(less, 0) - tension_(more, 0);
      c.rate = factor_[k] * tension_(less, 1) - tension_(more, 1);
      c.rounding = kResidualRounding * factor_[k] * tension_.cwiseAbs().maxCoeff();
    }
    c.value = base + place_ * c.rate;
    return c;
  }

  /// If there are several solutions, the path may reverse: a released condition must not move in the forbidden
  /// direction.
  void turnIfNeeded(const LinearConstraint& changed) {
    const LinearConstraint c = condition(changed.eyelet, changed.change);
    if (c.rate * direction_ < -c.rounding) direction_ = -direction_;
  }

  double nextChange(const LinearConstraint& changed, LinearConstraint& next) const {
    double min = std::numeric_limits<double>::infinity();
    const auto consider = [&](int k, Eyelet change) {
      if (k == changed.eyelet && change == changed.change) return;
      const LinearConstraint c = condition(k, change);
      if (c.rate * direction_ >= -c.rounding) return;
      const double step = std::max(0.0, c.value) / std::abs(c.rate);
      if (step >= min) return;
      min = step;
      next = c;
    };
    for (int k = 0; k < factor_.size(); ++k) {
      if (eyelets_[k] == Eyelet::Smooth) continue;
      if (eyelets_[k] != Eyelet::Sticks) {
        consider(k, Eyelet::Sticks);
      } else {
        consider(k, Eyelet::Forward);
        consider(k, Eyelet::Backward);
      }
    }
    return min;
  }

  const SegmentMatrix& compliance_;
  const SegmentVector& factor_;
  Eyelets& eyelets_;
  Tight tight_;
  SegmentPath residual_, tension_, slide_;
  double residual_scale_ = 0;
  double place_ = 0, direction_ = 1;
};

}  // namespace

bool solveLinked(const SegmentMatrix& compliance, const SegmentPath& residual, const SegmentVector& factor,
                 const Eyelets& eyelets, const Tight& tight, SegmentPath& tension, SegmentPath& slide) {
  const int m = static_cast<int>(residual.rows());
  std::array<int, kMaxThreadSegments> group;
  SegmentVector ratio(m);
  const int groups = groupSegments(factor, eyelets, tight, group, ratio);
  SegmentMatrix matrix = SegmentMatrix::Zero(groups, groups);
  SegmentPath right = SegmentPath::Zero(groups, 2);
  for (int i = 0; i < m; ++i) {
    if (group[i] < 0) continue;
    right.row(group[i]) += residual.row(i);
    for (int j = 0; j < m; ++j)
      if (group[j] >= 0) matrix(group[i], group[j]) += compliance(i, j) * ratio[j];
  }
  solveByOrderedLu(matrix, right);
  tension.resize(m, 2);
  slide.resize(std::max(0, m - 1), 2);
  for (int k = 0; k < m; ++k)
    tension.row(k) = group[k] < 0 ? Eigen::RowVector2d::Zero().eval() : (ratio[k] * right.row(group[k])).eval();
  Eigen::RowVector2d through(0, 0);
  for (int k = 0; k + 1 < m; ++k) {
    const bool linked = group[k] >= 0 && group[k] == group[k + 1];
    through =
        linked ? (through - residual.row(k) + compliance.row(k) * tension).eval() : Eigen::RowVector2d::Zero().eval();
    slide.row(k) = through;
  }
  return tension.allFinite() && slide.allFinite();
}

bool updatePath(const SegmentMatrix& compliance, const SegmentVector& residual, const SegmentVector& factor,
                Eyelets& eyelets, SegmentVector& tension, SegmentVector& slide) {
  Path path(compliance, residual, factor, eyelets);
  const bool reached = path.update();
  path.here(tension, slide);
  return reached;
}

}  // namespace vibe::detail

namespace vibe {

namespace {
// Problems solved for one thread. Design choice: the second has nearly always the right segments; those that are still
// missing are found when it is solved again.
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
