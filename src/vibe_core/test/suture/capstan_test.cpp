#include "suture/capstan.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>

#include "suture/thread_problems.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_testing/allocation_count.hpp"

namespace vibe::capstan_test {
namespace {

using Eigen::Vector3d;
using namespace test;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kPi = 3.14159265358979323846;

TEST(Capstan, AnglesOfTurn) {
  const Vector3d a(0, 0, 0), b(1, 0, 0);
  EXPECT_NEAR(turningAngle(a, b, {2, 0, 0}), 0, 1e-15);
  EXPECT_NEAR(turningAngle(a, b, {1, 3, 0}), kPi / 2, 1e-15);
  EXPECT_NEAR(turningAngle(a, b, {0.5, 0, 0}), kPi, 1e-15);
  EXPECT_NEAR(turningAngle(a, b, {2, 1e-9, 0}), 1e-9, 1e-17);
  EXPECT_EQ(turningAngle(a, a, b), 0);
}

TEST(Capstan, FactorIsExponential) {
  EXPECT_NEAR(capstanFactor(0.15, kPi / 2), std::exp(0.15 * kPi / 2), 1e-15);
  EXPECT_EQ(capstanFactor(0, kPi), 1);
  EXPECT_EQ(capstanFactor(kInfinity, 0), kInfinity);
  EXPECT_THROW(capstanFactor(-0.1, 1), Error);
  EXPECT_THROW(capstanFactor(0.1, std::nan("")), Error);
}

TEST(Capstan, FrictionlessThreadHasOneTension) {
  Problem p = even(7, 1);
  p.residual << 0.01, -0.004, 0.002, 0.03, -0.01, 0, 0.001;
  for (int k = 0; k < 7; ++k) p.compliance(k, k) = 1e-3 * (1 + k);
  const ThreadSlide r = solve(p);
  ASSERT_TRUE(r.converged);
  const double tension = p.residual.sum() / p.compliance.sum();
  for (int k = 0; k < 7; ++k) EXPECT_NEAR(r.tension[k] / tension, 1, 1e-12);
  EXPECT_LT(worstViolation(p, r), 1e-12);
}

TEST(Capstan, InfiniteFrictionLetsNothingSlide) {
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

TEST(Capstan, PullingAgainstAWeightMultipliesTheFactors) {
  Problem p = even(5, 1);
  p.factor << 1.2, 1.05, 1.7, 1.3;
  hangWeight(p, 0, 2);
  p.residual[4] = 0.1;  // drawn out at the far end: everything slides that way
  const ThreadSlide r = solve(p);
  ASSERT_TRUE(r.converged);
  double tension = 2;
  for (int k = 0; k < 4; ++k) {
    EXPECT_GT(r.slide[k], 0);
    tension *= p.factor[k];
    EXPECT_NEAR(r.tension[k + 1] / tension, 1, 1e-8);
  }
}

TEST(Capstan, LettingOutAgainstAWeightDividesByTheFactors) {
  Problem p = even(5, 1);
  p.factor << 1.2, 1.05, 1.7, 1.3;
  hangWeight(p, 0, 2);
  p.residual.tail(4).setConstant(5e-3);  // tensions of 5 N from a pull before
  p.residual[4] = -0.1;                  // let out: the weight draws it back
  const ThreadSlide r = solve(p);
  ASSERT_TRUE(r.converged);
  double tension = 2;
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

TEST(Capstan, PullAndReleaseMakeAHysteresis) {
  const double a = 1.5, weight = 1;
  Problem p = even(2, a);
  hangWeight(p, 0, weight, 1e3);  // [m/N]: what slides changes it by 4e-6 at most, and is not lost in rounding
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

TEST(Capstan, SlackThreadFeedsWhatLacksItWithTheLeastFriction) {
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

TEST(Capstan, MeetsEveryConditionOfRandomThreads) {
  Random random{1};
  for (int i = 0; i < 10000; ++i) {
    const Problem p = randomProblem(random, i % 2 == 0);
    const ThreadSlide r = solve(p);
    ASSERT_TRUE(r.converged) << i;
    ASSERT_LT(worstViolation(p, r), 1e-8) << i;
  }
}

TEST(Capstan, AWrongAnswerViolatesConditions) {
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

TEST(Capstan, TheThreadTurnedRoundGivesTheSameTurnedRound) {
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

TEST(Capstan, ScalesWithLengthAndForce) {
  Random random{4};
  for (int i = 0; i < 200; ++i) {
    const Problem p = randomProblem(random, true);
    const ThreadSlide r = solve(p);
    const ThreadSlide s = solve({p.residual * 1e4, p.compliance * 1e7, p.factor});
    EXPECT_LT((s.tension * 1e3 - r.tension).cwiseAbs().maxCoeff(), 1e-9 * r.tension.maxCoeff() + 1e-300);
    EXPECT_LT((s.slide * 1e-4 - r.slide).norm(), 1e-9 * p.residual.cwiseAbs().maxCoeff());
  }
}

TEST(Capstan, DoesNotDependOnWhatTheResultHeld) {
  Random random{5};
  ThreadSlide used;
  for (int i = 0; i < 200; ++i) {
    const Problem p = randomProblem(random, true);
    const ThreadSlide fresh = solve(p);
    slideThread(p.residual, p.compliance, p.factor, used);
    EXPECT_EQ(fresh.tension, used.tension);
    EXPECT_EQ(fresh.slide, used.slide);
  }
}

TEST(Capstan, LongThreadsAreExactAndNeedNoMemory) {
  Random random{6};
  Problem p = even(kMaxThreadSegments, 1);
  for (int k = 0; k < 64; ++k) p.residual[k] = random(-0.01, 0.03);
  for (int k = 0; k < 63; ++k) p.factor[k] = std::exp(random(0, 0.3));
  ThreadSlide r;
  slideThread(p.residual, p.compliance, p.factor, r);
  ASSERT_TRUE(r.converged);
  EXPECT_LT(worstViolation(p, r), 1e-10);
  [[maybe_unused]] const long before = test::allocations;
  slideThread(p.residual, p.compliance, p.factor, r);
#if VIBE_COUNTS_ALLOCATIONS
  EXPECT_EQ(test::allocations, before);
#endif
}

TEST(Capstan, RefusesWhatIsNoThread) {
  const Problem p = even(3, 1.2);
  ThreadSlide r;
  const auto expect = [&](Problem q) { EXPECT_THROW(slideThread(q.residual, q.compliance, q.factor, r), Error); };
  Problem q = p;
  q.residual[1] = std::nan("");
  expect(q);
  q = p;
  q.factor[0] = 0.5;
  expect(q);
  q = p;
  q.factor[0] = std::nan("");
  expect(q);
  q = p;
  q.compliance(2, 2) = 0;
  expect(q);
  q = p;
  q.residual.conservativeResize(2);
  expect(q);
  expect(even(65, 1.2));
  expect({VectorXd(), MatrixXd(), VectorXd()});
}

}  // namespace
}  // namespace vibe::capstan_test
