#include "suture/thread_run.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "arithmetic/elementary.hpp"
#include "arithmetic/ordered_algebra.hpp"
#include "arithmetic/ordered_lu.hpp"

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

/// The segment with spare length from which the friction to `taker` is least; -1: none.
int nearestGiver(int count, const double* factor, const double* slack, int taker) {
  int giver = -1;
  double min = std::numeric_limits<double>::infinity();
  for (const int direction : {-1, 1}) {
    double friction = 0;
    for (int k = taker + direction; k >= 0 && k < count; k += direction) {
      friction += math::log(factor[direction < 0 ? k : k - 1]);
      if (slack[k] <= 0) continue;
      if (friction < min) {
        min = friction;
        giver = k;
      }
      break;
    }
  }
  return giver;
}

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

void dealOut(int count, const double* factor, double* slack, double* slide) {
  for (int k = 0; k < count; ++k)
    while (slack[k] < 0) {
      const int giver = nearestGiver(count, factor, slack, k);
      if (giver < 0) break;  // rounding error
      const double amount = std::min(slack[giver], -slack[k]);
      slack[giver] -= amount;
      slack[k] += amount;
      for (int e = std::min(giver, k); e < std::max(giver, k); ++e) slide[e] += giver < k ? amount : -amount;
    }
}

}  // namespace vibe::detail
