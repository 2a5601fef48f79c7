#include "solver/thread_slides.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "solver/thread_problems.hpp"
#include "vibe_testing/allocation_count.hpp"

namespace vibe::thread_slides_test {
namespace {

using namespace test;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

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

TEST(ThreadSlides, FrictionlessThreadHasOneTension) {
  Problem p = even(7, 1);
  p.residual << 0.01, -0.004, 0.002, 0.03, -0.01, 0, 0.001;
  for (int k = 0; k < 7; ++k) p.compliance(k, k) = 1e-3 * (1 + k);
  const ThreadSlide r = solve(p);
  ASSERT_TRUE(r.converged);
  const double tension = p.residual.sum() / p.compliance.sum();
  for (int k = 0; k < 7; ++k) EXPECT_NEAR(r.tension[k] / tension, 1, 1e-12);
  EXPECT_LT(worstViolation(p, r), 1e-12);
}

TEST(ThreadSlides, InfiniteFrictionLetsNothingSlide) {
  Problem p = even(4, kInfinity);
  p.residual << 0.01, -0.004, 0.002, 0.03;
  p.compliance(0, 1) = p.compliance(1, 0) = -5e-4;
  p.compliance(2, 3) = p.compliance(3, 2) = 3e-4;
  const ThreadSlide r = solve(p);
  ASSERT_TRUE(r.converged);
  EXPECT_EQ(r.slide.cwiseAbs().maxCoeff(), 0);
  EXPECT_LT(worstViolation(p, r), 1e-12);
  EXPECT_NEAR(r.tension[0], 0.01 / 1e-3 + 0.5 * r.tension[1], 1e-9);
}

TEST(ThreadSlides, PullingAgainstAWeightMultipliesTheFactors) {
  Problem p = even(5, 1);
  p.factor << 1.2, 1.05, 1.7, 1.3;
  hangWeight(p, 0, 2);
  p.residual[4] = 0.1;  // drawn out at the far end: everything slides that way
  const ThreadSlide r = solve(p);
  ASSERT_TRUE(r.converged);
  double tension = r.tension[0];
  EXPECT_NEAR(tension, 2, 1e-3);
  for (int k = 0; k < 4; ++k) {
    EXPECT_GT(r.slide[k], 0);
    tension *= p.factor[k];
    EXPECT_NEAR(r.tension[k + 1] / tension, 1, 1e-8);
  }
}

TEST(ThreadSlides, LettingOutAgainstAWeightDividesByTheFactors) {
  Problem p = even(5, 1);
  p.factor << 1.2, 1.05, 1.7, 1.3;
  hangWeight(p, 0, 2);
  p.residual.tail(4).setConstant(5e-3);  // tensions of 5 N from a pull before
  p.residual[4] = -0.1;                  // let out: the weight draws it back
  const ThreadSlide r = solve(p);
  ASSERT_TRUE(r.converged);
  double tension = r.tension[0];
  EXPECT_NEAR(tension, 2, 1e-3);
  for (int k = 0; k < 4; ++k) {
    EXPECT_LT(r.slide[k], 0);
    tension /= p.factor[k];
    EXPECT_NEAR(r.tension[k + 1] / tension, 1, 1e-8);
  }
}

/// Material moved by a step: what the next one starts from.
void moveMaterial(const ThreadSlide& r, VectorXd& residual) {
  for (int k = 0; k < r.slide.size(); ++k) {
    residual[k] += r.slide[k];
    residual[k + 1] -= r.slide[k];
  }
}

TEST(ThreadSlides, PullAndReleaseMakeAHysteresis) {
  const double a = 1.5, weight = 1;
  Problem p = even(2, a);
  hangWeight(p, 0, weight);
  std::vector<double> pull, release;
  const auto drive = [&](double step, std::vector<double>& tension) {
    for (int i = 0; i < 20; ++i) {
      p.residual[1] += step;
      const ThreadSlide r = solve(p);
      ASSERT_TRUE(r.converged);
      moveMaterial(r, p.residual);
      tension.push_back(r.tension[1]);
    }
  };
  drive(1e-4, pull);
  drive(-1e-4, release);
  // The weight first takes the slack as far as friction lets it, W / a; then a straight rise by step over compliance up
  // to a W, the same way back, and down to W / a: not below.
  for (int i = 0; i < 20; ++i) {
    EXPECT_NEAR(pull[i], std::min(a * weight, weight / a + 0.1 * i), 1e-5) << i;
    EXPECT_NEAR(release[i], std::max(weight / a, a * weight - 0.1 * (i + 1)), 1e-5) << i;
  }
}

TEST(ThreadSlides, SlackThreadFeedsWhatLacksItWithTheLeastFriction) {
  Problem p = even(4, 1.2);
  p.factor << 1.5, 1.1, 1.3;
  p.residual << -0.02, 0.005, -0.003, -0.02;
  const ThreadSlide r = solve(p);
  ASSERT_TRUE(r.converged);
  EXPECT_EQ(r.tension.maxCoeff(), 0);
  // 3 mm come through the eyelet of least friction; the rest over it and the next (1.1 x 1.3) rather than over 1.5.
  EXPECT_NEAR(r.slide[0], 0, 1e-15);
  EXPECT_NEAR(r.slide[1], -0.005, 1e-15);
  EXPECT_NEAR(r.slide[2], -0.002, 1e-15);
  EXPECT_LT(worstViolation(p, r), 1e-14);
}

Problem randomProblem(Random& random, bool tissue) {
  const int m = 1 + static_cast<int>(random(0, 9));
  Problem p = even(m, 1);
  for (int k = 0; k < m; ++k) {
    p.residual[k] = random(-1, 1) * std::pow(10, random(-5, -1)) + random(-0.01, 0.03);
    p.compliance(k, k) = std::pow(10, random(-5, -1));
  }
  for (int k = 0; k + 1 < m; ++k) {
    const double kind = random(0, 1);
    p.factor[k] = kind < 0.1 ? 1 : kind < 0.2 ? kInfinity : std::exp(random(0, 1.5));
  }
  if (!tissue) return p;
  // Eyelets on springs, each moved by the two segments beside it: neighbours give by the cosine of the turn.
  for (int k = 0; k + 1 < m; ++k) {
    const double give = std::pow(10, random(-4, -1)), cosine = random(-1, 1);
    p.compliance(k, k) += give;
    p.compliance(k + 1, k + 1) += give;
    p.compliance(k, k + 1) -= give * cosine;
    p.compliance(k + 1, k) -= give * cosine;
  }
  return p;
}

TEST(ThreadSlides, MeetsEveryConditionOfRandomThreads) {
  Random random{1};
  for (int i = 0; i < 10000; ++i) {
    const Problem p = randomProblem(random, i % 2 == 0);
    const ThreadSlide r = solve(p);
    ASSERT_TRUE(r.converged) << i;
    ASSERT_LT(worstViolation(p, r), 1e-8) << i;
  }
}

TEST(ThreadSlides, AWrongAnswerViolatesConditions) {
  Random random{2};
  int tense = 0;
  for (int i = 0; i < 200; ++i) {
    const Problem p = randomProblem(random, true);
    ThreadSlide r = solve(p);
    if (r.tension.maxCoeff() == 0) continue;
    ++tense;
    r.tension[0] = 1.001 * r.tension[0] + 1e-3 * r.tension.maxCoeff();
    EXPECT_GT(worstViolation(p, r), 1e-9);
  }
  EXPECT_GT(tense, 100);
}

TEST(ThreadSlides, TheThreadTurnedRoundGivesTheSameTurnedRound) {
  Random random{3};
  for (int i = 0; i < 500; ++i) {
    Problem p = randomProblem(random, false);
    const ThreadSlide r = solve(p);
    if (r.tension.minCoeff() == 0) continue;  // slides of slack threads are not unique
    Problem q{p.residual.reverse(), p.compliance.reverse(), p.factor.reverse()};
    const ThreadSlide s = solve(q);
    const double force = r.tension.maxCoeff(), length = p.residual.cwiseAbs().maxCoeff();
    EXPECT_LT((s.tension.reverse() - r.tension).cwiseAbs().maxCoeff(), 1e-9 * force) << i;
    EXPECT_LT((s.slide.reverse() + r.slide).norm(), 1e-8 * length) << i;
  }
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
  for (int k = 0; k < 14; ++k) p.factor[k] = k % 5 == 4 ? kInfinity : random(1, 1.6);
  Eigen::MatrixXd share(15, 15);
  for (int i = 0; i < 15; ++i)
    for (int j = 0; j < 15; ++j) share(i, j) = random(-1, 1);
  p.compliance += 2e-5 * share * share.transpose();
  for (int k = 0; k < 15; ++k) p.residual[k] = random(-4e-3, k < 10 ? 6e-3 : 4e-3);
  return p;
}

// A knot between threads makes them one.
TEST(ThreadSlides, AllTogetherMeetTheConditionsOfEach) {
  Random random{7};
  int slack = 0, failures = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const Problem p = threeThreads(random);
    Threads threads(p, Eigen::VectorXd::Constant(15, 1.0), {5, 5, 5});
    const ThreadSlide r = threads.solve(p.residual);
    failures += r.converged ? 0 : 1;
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

TEST(ThreadSlides, WithoutARightGuessItIsTheOneThatMissesLeast) {
  Random random{5};
  double lacking = 0, missing = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const Problem p = threeThreads(random);
    double least = HUGE_VAL;
    lacking += p.residual.maxCoeff();
    for (const int guesses : {1, 2, 3, 4, 5}) {
      Threads threads(p, Eigen::VectorXd::Constant(15, 1.0), {5, 5, 5}, guesses);
      const ThreadSlide r = threads.solve(p.residual);
      EXPECT_LE(threads.slides.violation(), least) << trial << ", " << guesses;
      least = threads.slides.violation();
      missing += guesses == 2 ? least : 0;
      EXPECT_EQ(r.converged, worstViolation(p, r) < 1e-8) << trial << ", " << guesses;
      EXPECT_GE(r.tension.minCoeff(), 0) << trial << ", " << guesses;
      for (int k = 0; k < 14; ++k)
        EXPECT_FALSE(r.slide[k] * (r.tension[k + 1] - r.tension[k]) < 0)
            << "driven by friction: " << trial << ", " << k;
    }
  }
  EXPECT_LT(missing, 0.5 * lacking);
}

TEST(ThreadSlides, WithoutASolutionNothingPullsAndItSaysWhatLacks) {
  Problem p = drawn();
  p.compliance.setZero();
  Threads threads(p, Eigen::VectorXd::Zero(4), {4});
  const ThreadSlide r = threads.solve(p.residual);
  EXPECT_EQ(r.tension.maxCoeff(), 0);
  EXPECT_EQ(threads.slides.violation(), p.residual[0]);
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
