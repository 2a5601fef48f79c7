#pragma once
#include "suture/thread_run.hpp"

namespace vibe {

/// slideThread() for a thread whose segments cannot become shorter than a fold of the wall: segment k gives away at
/// most `spare` of its thread. A segment that has given it away keeps its length, and what is drawn through it passes
/// from its one neighbour to the other against the friction of both eyelets.
class LimitedSlide {
 public:
  /// Arguments as for slideThread().
  /// @param spare  per segment, 0 or more [m], (m)
  /// @param result  tensions, slides and slacks; `converged` of the last problem that was solved
  void solve(const Eigen::Ref<const Eigen::VectorXd>& residual, const Eigen::Ref<const Eigen::MatrixXd>& compliance,
             const Eigen::Ref<const Eigen::VectorXd>& capstan_factor, const Eigen::Ref<const Eigen::VectorXd>& spare,
             ThreadSlide& result);

 private:
  void orderSegments(const Eigen::Ref<const Eigen::VectorXd>& capstan_factor);
  void solveOrdered(const Eigen::Ref<const Eigen::MatrixXd>& compliance, ThreadSlide& result);
  bool exhaust(const Eigen::Ref<const Eigen::VectorXd>& spare, const ThreadSlide& result);
  void giveAway(int segment, double amount, int direction);

  int count_ = 0, kept_ = 0;
  detail::Tight exhausted_{};
  std::array<int, kMaxThreadSegments> order_{};  // those that still slide, along the thread, then the exhausted ones
  detail::SegmentVector lack_, given_;           // given: slides of what exhausted segments have given away
  detail::SegmentVector factor_, ordered_lack_;
  detail::SegmentMatrix ordered_compliance_;
  ThreadSlide ordered_;
};

}  // namespace vibe
