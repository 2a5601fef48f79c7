#include "solver/thread_slides.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "suture/thread_problems.hpp"
#include "vibe_testing/allocation_count.hpp"

namespace vibe::thread_slides_test {
namespace {

using namespace test;

/// Threads that follow each other in one problem, each with so many segments.
struct Threads {
  Threads(const Problem& p, const Eigen::VectorXd& spare, const std::vector<int>& counts, int guesses = 12)
      : slides(guesses) {
    int first = 0;
    for (const int count : counts) {
      slides.addThread();
      for (int k = first; k < first + count; ++k) slides.addSegment(k + 1 < first + count ? p.factor[k] : 1, spare[k]);
      first += count;
    }
    setCompliance(p.compliance);
  }
  void setCompliance(const Eigen::MatrixXd& compliance) {
    slides.beginCompliance();
    for (int i = 0; i < slides.size(); ++i)
      for (int j = 0; j < slides.size(); ++j) slides.compliance(i, j) = compliance(i, j);
  }
  ThreadSlide solve(const Eigen::VectorXd& lack) {
    const int sweeps = slides.solve(lack.data());
    ThreadSlide r;
    r.converged = sweeps == 1;
    const int m = slides.size();
    r.tension.resize(m), r.slide.resize(m - 1);
    for (int k = 0; k < m; ++k) r.tension[k] = slides.tension(k);
    for (int k = 0; k + 1 < m; ++k) r.slide[k] = slides.slide(k);
    return r;
  }
  ThreadSlides slides;
};

ThreadSlide solveLimited(const Problem& p, const Eigen::VectorXd& spare) {
  return Threads(p, spare, {static_cast<int>(p.residual.size())}).solve(p.residual);
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

TEST(ThreadSlides, WithEnoughThreadItIsThatOfAThreadThroughEyelets) {
  const Problem p = drawn();
  const ThreadSlide free = solve(p), r = solveLimited(p, Eigen::VectorXd::Constant(4, 1.0));
  ASSERT_TRUE(r.converged);
  EXPECT_LT((r.tension - free.tension).cwiseAbs().maxCoeff(), 1e-12 * free.tension.maxCoeff());
  EXPECT_LT((r.slide - free.slide).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(ThreadSlides, ASegmentGivesAwayWhatItHasAndThreadPassesThroughIt) {
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

TEST(ThreadSlides, NothingLeavesSegmentsWithoutSpareThread) {
  const Problem p = drawn();
  const ThreadSlide r = solveLimited(p, Eigen::VectorXd::Zero(4));
  for (int k = 0; k < 4; ++k) EXPECT_LE(given(r, k), 1e-10) << k;
  EXPECT_NEAR(r.tension[0], p.residual[0] / p.compliance(0, 0), 1e-9) << "nothing slid";
  EXPECT_GT(solve(p).slide.cwiseAbs().maxCoeff(), 1e-3) << "negative control: it slides where there is thread";
}

TEST(ThreadSlides, AnExhaustedSegmentStillTakesThread) {
  Problem p = even(3, 1.1);
  p.residual << 0.001, 0.02, 0.001;  // the one without spare thread is drawn itself
  Eigen::VectorXd spare = Eigen::VectorXd::Constant(3, 1.0);
  spare[1] = 0;
  const ThreadSlide free = solve(p), r = solveLimited(p, spare);
  ASSERT_LT(given(free, 1), -1e-3);
  EXPECT_LT((r.slide - free.slide).cwiseAbs().maxCoeff(), 1e-15);
}

/// Three threads, one of them often slack, that pull at the same tissue.
Problem threeThreads(Random& random) {
  Problem p = even(15, 1);
  for (int k = 0; k < 14; ++k) p.factor[k] = k % 5 == 4 ? std::numeric_limits<double>::infinity() : random(1, 1.6);
  Eigen::MatrixXd share(15, 15);
  for (int i = 0; i < 15; ++i)
    for (int j = 0; j < 15; ++j) share(i, j) = random(-1, 1);
  p.compliance += 2e-5 * share * share.transpose();
  for (int k = 0; k < 15; ++k) p.residual[k] = random(-4e-3, k < 10 ? 6e-3 : 4e-3);
  return p;
}

// A knot between threads makes them one, which slideThread() can solve.
TEST(ThreadSlides, AllTogetherMeetTheConditionsOfEach) {
  Random random{7};
  int slack = 0, failures = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const Problem p = threeThreads(random);
    Threads threads(p, Eigen::VectorXd::Constant(15, 1.0), {5, 5, 5});
    ThreadSlide r = threads.solve(p.residual);
    failures += threads.slides.failures();
    r.slack = p.compliance * r.tension - p.residual;
    for (int k = 0; k < 14; ++k) r.slack[k] -= r.slide[k], r.slack[k + 1] += r.slide[k];
    EXPECT_LT(worstViolation(p, r), 1e-8) << trial;
    slack += r.tension.tail(5).maxCoeff() == 0 ? 1 : 0;
  }
  EXPECT_GT(slack, 20);
  EXPECT_LT(failures, 1) << "guesses that do not end";
}

TEST(ThreadSlides, WhatWasSolvedBeforeMakesNoDifferenceButForRounding) {
  Random random{3};
  for (int trial = 0; trial < 100; ++trial) {
    const Problem before = threeThreads(random), p = threeThreads(random);
    const Eigen::VectorXd spare = Eigen::VectorXd::Constant(15, 1e-3);
    Threads used({p.residual, before.compliance, p.factor}, spare, {5, 5, 5});
    used.solve(before.residual);
    used.setCompliance(p.compliance);
    const ThreadSlide r = used.solve(p.residual), fresh = Threads(p, spare, {5, 5, 5}).solve(p.residual);
    EXPECT_LT((r.tension - fresh.tension).cwiseAbs().maxCoeff(), 1e-8) << trial;
    EXPECT_LT((r.slide - fresh.slide).cwiseAbs().maxCoeff(), 1e-10) << trial;
  }
}

TEST(ThreadSlides, OneAfterTheOtherTheyAreTheSame) {
  Random random{5};
  int exhausted = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const Problem p = threeThreads(random);
    const Eigen::VectorXd spare = Eigen::VectorXd::Constant(15, 2e-3);
    const ThreadSlide r = Threads(p, spare, {5, 5, 5}).solve(p.residual);
    Threads alone(p, spare, {5, 5, 5}, 0);
    const ThreadSlide one_by_one = alone.solve(p.residual);
    EXPECT_GT(alone.slides.failures(), 0);
    EXPECT_LT((r.tension - one_by_one.tension).cwiseAbs().maxCoeff(), 1e-3) << trial;
    EXPECT_LT((r.slide - one_by_one.slide).cwiseAbs().maxCoeff(), 1e-6) << trial;
    for (int k = 0; k < 15; ++k) exhausted += given(r, k) > spare[k] - 1e-9 ? 1 : 0;
  }
  EXPECT_GT(exhausted, 20);
}

TEST(ThreadSlides, DoesNotAllocate) {
  const Problem p = drawn();
  Threads threads(p, Eigen::VectorXd::Zero(4), {4});
  threads.slides.solve(p.residual.data());
  const long before = allocations;
  threads.slides.solve(p.residual.data());
  EXPECT_EQ(allocations - before, 0);
}

}  // namespace
}  // namespace vibe::thread_slides_test
