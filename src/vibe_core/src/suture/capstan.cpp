#include "suture/capstan.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "arithmetic/elementary.hpp"
#include "arithmetic/ordered_algebra.hpp"
#include "suture/thread_run.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe {

namespace {

using namespace detail;

constexpr double kTolerance = 1e-9;
constexpr int kMaxSweeps = 300;

void checkCapstan(bool right, const char* what, const char* remedy) {
  if (!right) throw Error(std::string("A thread through eyelets was given ") + what + ": " + remedy + ".");
}

/// Segments first..last between two eyelets that hold (or ends), within which thread slides freely or with friction.
struct Run {
  int first, last;
  int size() const { return last - first + 1; }
};

class SlideProblem {
 public:
  SlideProblem(const Eigen::Ref<const Eigen::VectorXd>& residual, const Eigen::Ref<const Eigen::MatrixXd>& compliance,
               const Eigen::Ref<const Eigen::VectorXd>& factor)
      : residual_(residual), factor_(factor), compliance_(compliance) {
    const int m = static_cast<int>(residual_.size());
    tension_ = SegmentVector::Zero(m);
    slide_ = SegmentVector::Zero(m - 1);
    slack_ = SegmentVector::Zero(m);
    eyelets_.fill(Eyelet::Sticks);
    tight_.fill(false);
    Run run{0, 0};
    for (int k = 0; k < m; ++k) {
      run.last = k;
      if (k + 1 < m && !holds(k)) continue;
      runs_[run_count_++] = run;
      run.first = k + 1;
    }
  }

  /// Runs are coupled only through the tissue. Each is solved for given tensions of the others until the sets of
  /// sticking, sliding and slack parts are right; these sets then determine the joint solution of all runs.
  bool solve() {
    bool reached = false;
    for (int sweep = 0; sweep < kMaxSweeps; ++sweep) {
      reached = true;
      for (int r = 0; r < run_count_; ++r) reached = solveRun(runs_[r]) && reached;
      if (run_count_ > 1 && reached) solveTogether();
      takeUpSlack();
      if (isSolution()) return true;
      if (run_count_ == 1) return false;
    }
    return false;
  }

  void write(ThreadSlide& result) const {
    result.tension = tension_.cwiseMax(0);
    result.slide = slide_;
    result.slack = slack_.cwiseMax(0);
  }

 private:
  bool holds(int k) const { return factor_[k] >= kHoldingFactor; }

  /// Missing length of the segments without the pull of the other runs.
  SegmentVector residualOf(const Run& run) const {
    SegmentVector others = tension_;
    others.segment(run.first, run.size()).setZero();
    SegmentVector missing = residual_.segment(run.first, run.size());
    addProduct(compliance_.middleRows(run.first, run.size()), others, -1, missing);
    return missing;
  }

  /// How much the pull of all segments shortens the path of each.
  SegmentVector shortened() const {
    SegmentVector sum = SegmentVector::Zero(residual_.size());
    addProduct(compliance_, tension_, 1, sum);
    return sum;
  }

  bool solveRun(const Run& run) {
    const int n = run.size();
    const SegmentVector residual = residualOf(run);
    const bool tight = residual.sum() > 0;
    std::fill_n(tight_.begin() + run.first, n, tight);
    tension_.segment(run.first, n).setZero();
    if (!tight) return true;
    const SegmentMatrix compliance = compliance_.block(run.first, run.first, n, n);
    const SegmentVector factor = factor_.segment(run.first, n - 1);
    Eyelets eyelets;
    eyelets.fill(Eyelet::Sticks);
    SegmentVector tension, slide;
    const bool reached = updatePath(compliance, residual, factor, eyelets, tension, slide);
    std::copy_n(eyelets.begin(), n - 1, eyelets_.begin() + run.first);
    tension_.segment(run.first, n) = tension;
    slide_.segment(run.first, n - 1) = slide;
    return reached;
  }

  void solveTogether() {
    SegmentPath residual(residual_.size(), 2), tension, slide;
    residual.col(0) = residual_;
    residual.col(1).setZero();
    if (!solveLinked(compliance_, residual, factor_, eyelets_, tight_, tension, slide)) return;
    if (tension.col(0).minCoeff() < 0) return;  // not yet the right sets: continue from the tensions of the single runs
    tension_ = tension.col(0);
    slide_ = slide.col(0);
  }

  /// Distributes the thread of slack runs, and computes the remainder.
  void takeUpSlack() {
    const int m = static_cast<int>(residual_.size());
    slack_ = shortened() - residual_;
    for (int r = 0; r < run_count_; ++r)
      if (const Run& run = runs_[r]; !tight_[run.first]) {
        slide_.segment(run.first, run.size() - 1).setZero();
        dealOut(run.size(), factor_.data() + run.first, slack_.data() + run.first, slide_.data() + run.first);
      }
    for (int k = 0; k + 1 < m; ++k) {
      if (!tight_[k] || !tight_[k + 1]) continue;
      slack_[k] -= slide_[k];
      slack_[k + 1] += slide_[k];
    }
  }

  bool isSolution() const {
    const double max = tension_.cwiseAbs().maxCoeff();
    const double length = kTolerance * (residual_.cwiseAbs() + shortened().cwiseAbs()).maxCoeff();
    const double force = kTolerance * max;
    for (int k = 0; k < residual_.size(); ++k) {
      if (!(tension_[k] >= -force) || !(slack_[k] >= -length)) return false;
      if (tension_[k] > force && !(slack_[k] <= length)) return false;
    }
    for (int k = 0; k < slide_.size(); ++k)
      if (!eyeletIsRight(k, force, length)) return false;
    return true;
  }

  bool eyeletIsRight(int k, double force, double length) const {
    if (holds(k)) return slide_[k] == 0;
    const double forward = factor_[k] * tension_[k] - tension_[k + 1];
    const double backward = factor_[k] * tension_[k + 1] - tension_[k];
    const double rounding = force * factor_[k];
    if (!(forward >= -rounding) || !(backward >= -rounding)) return false;
    if (slide_[k] > length && !(forward <= rounding)) return false;
    return !(slide_[k] < -length && !(backward <= rounding));
  }

  SegmentVector residual_, factor_, tension_, slide_, slack_;
  SegmentMatrix compliance_;
  std::array<Run, kMaxThreadSegments> runs_;
  int run_count_ = 0;
  Eyelets eyelets_;
  Tight tight_;
};

void checkProblem(const Eigen::Ref<const Eigen::VectorXd>& residual,
                  const Eigen::Ref<const Eigen::MatrixXd>& compliance,
                  const Eigen::Ref<const Eigen::VectorXd>& factor) {
  const Eigen::Index m = residual.size();
  checkCapstan(m >= 1 && m <= kMaxThreadSegments, "no segments or more than 64",
               "give 1 to 64, and divide a longer thread at a point that holds it");
  checkCapstan(compliance.rows() == m && compliance.cols() == m && factor.size() == m - 1,
               "sizes that do not fit each other",
               "give a square compliance of that size and a capstan factor per eyelet between two segments");
  checkCapstan(residual.allFinite() && compliance.allFinite(), "lengths or compliances that are not finite",
               "checkCapstan the positions of the eyelets and the stiffness of the tissue");
  checkCapstan((compliance.diagonal().array() > 0).all() && compliance.sum() > 0, "a compliance that is not positive",
               "a segment must give when it is pulled, at least by the stretch of its thread");
  checkCapstan((factor.array() >= 1).all(), "a capstan factor that is not 1 or more", "take it from capstanFactor()");
}

}  // namespace

double turningAngle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const Eigen::Vector3d in = b - a, out = c - b;
  return math::atan2(in.cross(out).norm(), in.dot(out));
}

double capstanFactor(double friction, double angle) {
  if (!(friction >= 0) || !(angle >= 0))
    throw Error("An eyelet has the friction " + std::to_string(friction) + " and turns the thread by " +
                std::to_string(angle) + " rad: both must be numbers from 0 on.");
  if (friction == 0 || angle == 0) return std::isinf(friction) ? friction : 1;
  return math::exp(friction * angle);
}

void slideThread(const Eigen::Ref<const Eigen::VectorXd>& residual, const Eigen::Ref<const Eigen::MatrixXd>& compliance,
                 const Eigen::Ref<const Eigen::VectorXd>& capstan_factor, ThreadSlide& result) {
  checkProblem(residual, compliance, capstan_factor);
  SlideProblem problem(residual, compliance, capstan_factor);
  result.converged = problem.solve();
  problem.write(result);
}

}  // namespace vibe
