// The work of a step is limited by counts. What a step leaves over is seen again by the next, and shrinks.
#include <gtest/gtest.h>

#include <algorithm>

#include "solver/implicit_worlds.hpp"
#include "solver/step_solve.hpp"
#include "vibe_core/solver/step_policy.hpp"

namespace vibe::bounded_step_test {
namespace {

using namespace test;

constexpr int kIterations = 2;
constexpr int kFrames = 240;

std::unique_ptr<Body> disturbedBeam(double amount, double step = 1.0 / 60) {
  ElasticBody body = cantilever({8, 2, 2});
  body.mass_damping = 30;
  StepSettings settings;
  settings.step = step;
  settings.iterations = kIterations;
  auto run = std::make_unique<Body>(body, settings);
  const Eigen::VectorXd moved = randomDisplacement(run->nodes(), amount * kSide);
  for (int i = 0; i < run->nodes(); ++i)
    for (int k = 0; k < 3; ++k)
      if (body.fixed[i] == 0) run->motion.x[k][i] += moved[3 * i + k];
  return run;
}

double farthestFromRest(const Body& run) {
  double max = 0;
  for (int i = 0; i < run.nodes(); ++i) max = std::max(max, (run.position(i) - run.stepper.body().rest[i]).norm());
  return max;
}

StepOutcome solveAgain(Body& run) {
  run.stepper.beginAgain(run.memory, *run.scratch);
  StepSolve solve(run.stepper.plan(), run.motion.view(), run.loads, run.memory, *run.scratch);
  solve.foresee();
  return solve.finish();
}

// @returns the evaluations that it took
int abandonedSolve(Body& run) {
  run.stepper.begin(run.motion.view(), run.loads, run.memory, *run.scratch);
  StepSolve solve(run.stepper.plan(), run.motion.view(), run.loads, run.memory, *run.scratch);
  solve.foresee();
  return solve.abandon();
}

// Turned inside out in many places: the factor at rest is useless there.
TEST(BoundedStep, EveryStepOfATangledBeamTakesLimitedWorkAndItsResidualShrinks) {
  const std::unique_ptr<Body> beam = disturbedBeam(0.7);
  Body& run = *beam;
  std::vector<double> residual;
  int most = 0, unfinished = 0;
  for (int frame = 0; frame < kFrames; ++frame) {
    const StepOutcome outcome = run.step();
    ASSERT_TRUE(outcome.finite);
    ASSERT_LE(outcome.evaluations, kIterations + (outcome.fallback ? kSpareInFallback : kSpareEvaluations)) << frame;
    ASSERT_LE(outcome.solves, outcome.evaluations) << frame;
    most = std::max(most, outcome.evaluations);
    unfinished += outcome.arrived ? 0 : 1;
    residual.push_back(outcome.residual);
  }
  EXPECT_EQ(most, kIterations + kSpareInFallback) << "negative control: no step needed the limit";
  EXPECT_GT(unfinished, 0) << "negative control: every step arrived";
  const auto largest = [&](int from, int to) {
    return *std::max_element(residual.begin() + from, residual.begin() + to);
  };
  EXPECT_GT(largest(0, 10), 1e-4);
  EXPECT_LT(largest(60, 120), 0.1 * largest(0, 10));
  EXPECT_LT(largest(180, 240), 1e-6);
  EXPECT_LT(farthestFromRest(run), 1e-5);
}

TEST(BoundedStep, TheSolvesOfAStepShareTheirEvaluations) {
  const std::unique_ptr<Body> beam = disturbedBeam(0.7);
  Body& run = *beam;
  constexpr int kShared = 2 * (kIterations + kSpareEvaluations), kLeast = kIterations + 2;
  int most = 0;
  for (int frame = 0; frame < 10; ++frame) {
    const BodyMotion start = run.motion;
    int spent = run.step().evaluations;
    for (int again = 0; again < 2; ++again) {
      run.motion = start;
      spent += solveAgain(run).evaluations;
    }
    ASSERT_LE(spent, kShared + 2 * kLeast) << frame;
    most = std::max(most, spent);
  }
  EXPECT_GT(most, kShared) << "negative control: no step needed the limit";
}

TEST(BoundedStep, AnAbandonedSolveHasMovedNothingAndCostsAtMostItsStart) {
  const std::unique_ptr<Body> taken = disturbedBeam(0.1, 1e-3), abandoned = disturbedBeam(0.1, 1e-3);
  int kept = 0;
  for (int frame = 0; frame < 20; ++frame) {
    const StepOutcome one = taken->step();
    const BodyMotion start = abandoned->motion;
    const int wasted = abandonedSolve(*abandoned);
    ASSERT_EQ(abandoned->motion.x, start.x);
    const StepOutcome again = solveAgain(*abandoned);
    ASSERT_EQ(abandoned->motion.x, taken->motion.x) << frame;
    ASSERT_EQ(abandoned->motion.v, taken->motion.v) << frame;
    const int more = wasted + again.evaluations - one.evaluations;
    ASSERT_TRUE(more >= 0 && more <= 2) << frame;  // 2: the guess is given up, in both solves
    kept += more == 0 ? 1 : 0;
  }
  EXPECT_GE(kept, 3) << "a step that starts along a motion keeps the evaluation there";
}

TEST(BoundedStep, AStepThatDoesNotArriveIsFollowedByBackwardEuler) {
  const std::unique_ptr<Body> beam = disturbedBeam(0.7);
  Body& run = *beam;
  StepOutcome outcome = run.step();
  for (int frame = 1; frame < kFrames && outcome.arrived; ++frame) outcome = run.step();
  ASSERT_FALSE(outcome.arrived);
  EXPECT_FALSE(outcome.fallback) << "the scheme of a step is chosen before it";
  for (int i = 0; i < run.nodes(); ++i)
    for (const auto& a : run.motion.a) ASSERT_EQ(a[i], 0);
  EXPECT_TRUE(run.step().fallback);
}

// A history that knows nothing of the body: as if a node could be moved far without a force.
TEST(BoundedStep, ASearchThatFailsBeginsAgainWithoutTheHistory) {
  const std::unique_ptr<Body> beam = disturbedBeam(0.05), misled = disturbedBeam(0.05);
  const StepOutcome usual = beam->step();
  EXPECT_EQ(usual.ways.of(StepWay::SearchRestarted), 0);

  misled->stepper.begin(misled->motion.view(), misled->loads, misled->memory, *misled->scratch);
  StepSolve solve(misled->stepper.plan(), misled->motion.view(), misled->loads, misled->memory, *misled->scratch);
  solve.foresee();
  PairHistory& history = misled->scratch->history;
  std::fill(history.move[0].begin(), history.move[0].end(), 0.0F);
  history.change[0] = history.move[0];
  const int node = misled->nodes() - 1;
  history.move[0][4 * node] = 1;
  history.change[0][4 * node] = 1e-6F;
  history.curvature[0] = 1e6;
  history.count = 1;
  const StepOutcome outcome = solve.finish();
  EXPECT_GE(outcome.ways.of(StepWay::SearchRestarted), 1);
  EXPECT_TRUE(outcome.arrived);
  EXPECT_LT(outcome.residual, 2 * usual.residual + 1e-5);
}

/// Two steps of a beam whose last node a tool takes eight sides of an element aside at once. The first does not arrive.
StepOutcome takeAside(Body& run, double& left) {
  const int node = run.nodes() - 1;
  const double target = run.position(node).z() + 8 * kSide;
  run.loads.constraints.push_back({{node}, {Eigen::Vector3d::UnitZ()}, target});
  run.step();
  const StepOutcome outcome = run.step();
  left = std::abs(run.position(node).z() - target);
  return outcome;
}

// The line search admits small parts of so far a move only.
TEST(BoundedStep, WhatAToolHoldsGoesWhereTheToolGoes) {
  double left = 0, left_without = 0;
  EXPECT_EQ(takeAside(*disturbedBeam(0), left).ways.of(StepWay::ConstraintsMet), 1);
  StepPolicy never;
  never.satisfy_after = 1 << 20;
  const ScopedStepPolicy scoped(never);
  EXPECT_EQ(takeAside(*disturbedBeam(0), left_without).ways.of(StepWay::ConstraintsMet), 0);
  EXPECT_LT(left, 1e-6);
  EXPECT_GT(left_without, 1e-4);
}

// In a smooth motion the limit plays no part.
TEST(BoundedStep, ASmallDisturbanceTakesTheUsualWork) {
  const std::unique_ptr<Body> beam = disturbedBeam(0.01);
  Body& run = *beam;
  for (int frame = 0; frame < 30; ++frame) {
    const StepOutcome outcome = run.step();
    ASSERT_TRUE(outcome.arrived);
    ASSERT_LE(outcome.evaluations, 2 * kIterations + 2) << frame;
  }
}

}  // namespace
}  // namespace vibe::bounded_step_test
