#include "suture/thread_run.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "suture/thread_problems.hpp"
#include "vibe_testing/allocation_count.hpp"

namespace vibe::limited_slide_test {
namespace {

using namespace test;

ThreadSlide solveLimited(const Problem& p, const Eigen::VectorXd& spare) {
  ThreadSlide result;
  LimitedSlide().solve(p.residual, p.compliance, p.factor, spare, result);
  return result;
}

// What a segment gives away.
double given(const ThreadSlide& r, int k) {
  return (k < r.slide.size() ? r.slide[k] : 0) - (k > 0 ? r.slide[k - 1] : 0);
}

/// Drawn at the first segment.
Problem drawn() {
  Problem p = even(4, 1.2);
  p.residual << 0.02, 0.001, 0.001, 0.001;
  return p;
}

TEST(LimitedSlide, WithEnoughThreadItIsThatOfAThreadThroughEyelets) {
  const Problem p = drawn();
  const ThreadSlide free = solve(p), r = solveLimited(p, Eigen::VectorXd::Constant(4, 1.0));
  ASSERT_TRUE(r.converged);
  EXPECT_EQ(r.tension, free.tension);
  EXPECT_EQ(r.slide, free.slide);
}

TEST(LimitedSlide, ASegmentGivesAwayWhatItHasAndThreadPassesThroughIt) {
  const Problem p = drawn();
  const double natural = given(solve(p), 1);
  ASSERT_GT(natural, 1e-4) << "otherwise nothing is limited";
  Eigen::VectorXd spare = Eigen::VectorXd::Constant(4, 1.0);
  spare[1] = 0.25 * natural;
  const ThreadSlide r = solveLimited(p, spare);
  ASSERT_TRUE(r.converged);
  EXPECT_NEAR(given(r, 1), spare[1], 1e-12);
  EXPECT_LT(r.slide[0], -spare[1]) << "thread of the third segment passes through the second";
  EXPECT_NEAR(r.tension[0] / r.tension[2], 1.2 * 1.2, 1e-8) << "against the friction of both eyelets";
  const Eigen::VectorXd stretched = p.compliance * r.tension;
  for (int k = 0; k < 4; ++k) EXPECT_NEAR(stretched[k], p.residual[k] + given(r, k), 1e-12) << k;
}

TEST(LimitedSlide, NothingLeavesSegmentsWithoutSpareThread) {
  const Problem p = drawn();
  const ThreadSlide r = solveLimited(p, Eigen::VectorXd::Zero(4));
  for (int k = 0; k < 4; ++k) EXPECT_LE(given(r, k), 1e-10) << k;
  EXPECT_NEAR(r.tension[0], p.residual[0] / p.compliance(0, 0), 1e-9) << "nothing slid";
  EXPECT_GT(solve(p).slide.cwiseAbs().maxCoeff(), 1e-3) << "negative control: it slides where there is thread";
}

TEST(LimitedSlide, AnExhaustedSegmentStillTakesThread) {
  Problem p = even(3, 1.1);
  p.residual << 0.001, 0.02, 0.001;  // the one without spare thread is drawn itself
  Eigen::VectorXd spare = Eigen::VectorXd::Constant(3, 1.0);
  spare[1] = 0;
  const ThreadSlide free = solve(p), r = solveLimited(p, spare);
  ASSERT_LT(given(free, 1), -1e-3);
  EXPECT_EQ(r.slide, free.slide);
}

TEST(LimitedSlide, DoesNotAllocate) {
  const Problem p = drawn();
  const Eigen::VectorXd spare = Eigen::VectorXd::Zero(4);
  LimitedSlide slide;
  ThreadSlide result;
  slide.solve(p.residual, p.compliance, p.factor, spare, result);
  const long before = allocations;
  slide.solve(p.residual, p.compliance, p.factor, spare, result);
  EXPECT_EQ(allocations - before, 0);
}

}  // namespace
}  // namespace vibe::limited_slide_test
