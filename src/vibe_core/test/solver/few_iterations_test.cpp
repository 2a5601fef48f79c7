// Steps of one to three iterations stay with the converged motion, and what they leave over does not swing up.
#include <gtest/gtest.h>

#include <string>

#include "solver/balloon.hpp"
#include "vibe_core/solver/step_policy.hpp"

namespace vibe::few_iterations_test {
namespace {

using namespace test;

constexpr double kPull = 0.01, kTop = 0.95 * Ball::kRadius;
constexpr double kPulling = 0.5, kHeld = 0.75, kEnd = 1.5;  // [s]

enum class Kind { OnABed, Clamped, FullOfGas };

Ball makeBall(Kind kind, const StepSettings& settings) {
  BallOptions options = stomachWall();
  if (kind == Kind::Clamped) options.clamped = 0.8;
  if (kind != Kind::Clamped) options.foundation = 5e3;
  Ball ball(settings, options);
  if (kind == Kind::FullOfGas) ball.fill(1300);
  return ball;
}

// The mean height of the top is a condition.
LinearConstraint topAt(const Ball& ball, double moved) {
  LinearConstraint constraint;
  for (int i = 0; i < ball.run->nodes(); ++i)
    if (ball.run->stepper.body().rest[i].z() > kTop) constraint.node.push_back(i);
  const auto count = static_cast<double>(constraint.node.size());
  constraint.coefficient.assign(constraint.node.size(), Eigen::Vector3d::UnitZ() / count);
  for (const int i : constraint.node) constraint.target += ball.run->stepper.body().rest[i].z() / count;
  constraint.target += moved;
  return constraint;
}

double minimumJerk(double part) {
  const double s = std::min(1.0, part);
  return s * s * s * (10 - 15 * s + 6 * s * s);
}

// Of the motion, the wall, the foundation and the gas; but for the gas's at the start [J].
double energyOf(Ball& ball, double start_volume) {
  Body& run = *ball.run;
  double energy = run.kinetic() + run.stepper.elastic(run.motion.view(), *run.scratch).energy;
  const ElasticBody& body = run.stepper.body();
  for (int i = 0; i < run.nodes(); ++i)
    energy += 0.5 * body.foundation[i] * (run.position(i) - body.rest[i]).squaredNorm();
  if (ball.gas().control != GasLoad::Control::Amount) return energy;
  const double volume = ball.volume();
  return energy + ball.gas().ambient * (volume - start_volume) - ball.gas().amount * std::log(volume / start_volume);
}

struct Motion {
  std::vector<std::vector<Eigen::Vector3d>> frames;  // fifty a second or so
  double released = 0, max_after = 0;                // energy when it is let go, and at most later [J]
};

Motion pullAndLetGo(Kind kind, const StepSettings& settings) {
  Ball ball = makeBall(kind, settings);
  Motion motion;
  const double start_volume = ball.volume();
  const int every = std::max(1, static_cast<int>(std::lround(0.02 / settings.step)));
  const int held = static_cast<int>(kHeld / settings.step);
  for (int i = 1; i * settings.step < kEnd; ++i) {
    ball.run->loads.constraints.clear();
    if (i <= held)
      ball.run->loads.constraints.push_back(topAt(ball, kPull * minimumJerk(i * settings.step / kPulling)));
    EXPECT_TRUE(ball.run->step().finite);
    const double energy = energyOf(ball, start_volume);
    if (i == held) motion.released = energy;
    if (i > held) motion.max_after = std::max(motion.max_after, energy);
    if (i % every != 0) continue;
    motion.frames.emplace_back();
    for (int k = 0; k < ball.run->nodes(); ++k) motion.frames.back().push_back(ball.run->position(k));
  }
  return motion;
}

// Greatest over time of the root of the mean square over the nodes, of the pull.
double errorOf(const Motion& motion, const Motion& truth) {
  double worst = 0;
  for (std::size_t f = 0; f < truth.frames.size(); ++f) {
    double sum = 0;
    for (std::size_t i = 0; i < truth.frames[f].size(); ++i)
      sum += (motion.frames[f][i] - truth.frames[f][i]).squaredNorm();
    worst = std::max(worst, std::sqrt(sum / static_cast<double>(truth.frames[f].size())) / kPull);
  }
  return worst;
}

/// A step, its iterations, and what error they may leave with a spectral radius of 0.2, 0.5 and 0.8.
struct Few {
  const char* name;
  double step;
  int iterations;
  double error[3];
};
constexpr Few kFew[] = {{"two_per_frame", 1.0 / 60, 2, {0.045, 0.07, 0.15}},
                        {"three_per_frame", 1.0 / 60, 3, {0.02, 0.02, 0.1}},
                        {"one_per_millisecond", 1e-3, 1, {0.045, 0.04, 0.035}}};
constexpr double kRadii[] = {0.2, 0.5, 0.8};

class FewIterations : public ::testing::TestWithParam<std::tuple<Kind, int, int>> {};

TEST_P(FewIterations, StayWithTheConvergedMotion) {
  const auto [kind, radius, which] = GetParam();
  const Few& few = kFew[which];
  StepSettings settings;
  settings.step = few.step;
  settings.spectral_radius = kRadii[radius];
  settings.iterations = 20;
  const Motion truth = pullAndLetGo(kind, settings);
  settings.iterations = few.iterations;
  const Motion motion = pullAndLetGo(kind, settings);
  const double error = errorOf(motion, truth);
  RecordProperty("error_of_the_pull", std::to_string(error));
  EXPECT_LT(error, few.error[radius]);
  EXPECT_GT(error, 0) << "these are not other iterations";
  EXPECT_GT(motion.released, 1e-4);
  EXPECT_LE(motion.max_after, motion.released);
}

// Where a step starts at positions that have far more energy than the last step ended with, it does not get far enough.
TEST(FewIterationsOfABall, AGuessWithFarMoreEnergyIsGivenUp) {
  StepSettings settings;
  settings.spectral_radius = 0.5;
  settings.iterations = 20;
  const Motion truth = pullAndLetGo(Kind::Clamped, settings);
  settings.iterations = 3;
  const double given_up = errorOf(pullAndLetGo(Kind::Clamped, settings), truth);
  StepPolicy keeps;
  keeps.guess_growth = 1e300;
  const ScopedStepPolicy scoped(keeps);
  EXPECT_LT(given_up, 0.7 * errorOf(pullAndLetGo(Kind::Clamped, settings), truth));
}

std::string nameOf(const ::testing::TestParamInfo<FewIterations::ParamType>& info) {
  const char* const kinds[] = {"on_a_bed", "clamped", "full_of_gas"};
  return kinds[static_cast<int>(std::get<0>(info.param))] + std::string("_") + kFew[std::get<2>(info.param)].name +
         "_keeping_" + std::to_string(static_cast<int>(10 * kRadii[std::get<1>(info.param)])) + "_tenths";
}
INSTANTIATE_TEST_SUITE_P(Pull, FewIterations,
                         ::testing::Combine(::testing::Values(Kind::OnABed, Kind::Clamped, Kind::FullOfGas),
                                            ::testing::Range(0, 3), ::testing::Range(0, 3)),
                         nameOf);

// Gas is a thousand times stiffer than the wall: where its share of the step is not eliminated exactly, as when fixed
// nodes count as if they moved, few iterations leave a wrong pressure.
TEST(FewIterationsWithGas, FindThePressureWhereNodesAreFixed) {
  for (const double clamped : {0.8, 0.3, 0.0}) {
    double pressure[4];
    const int iterations[4] = {20, 1, 2, 3};
    for (int k = 0; k < 4; ++k) {
      BallOptions options = stomachWall();
      options.clamped = clamped;
      StepSettings settings;
      settings.iterations = iterations[k];
      Ball ball(settings, options);
      ball.fill(1300);
      for (int i = 1; i <= 90; ++i) {
        ball.run->loads.constraints = {topAt(ball, -0.01 * minimumJerk((i - 30) / 30.0 * (i > 30 ? 1 : 0)))};
        ball.run->step();
      }
      pressure[k] = ball.gas().amount / ball.volume() - ball.gas().ambient;
      EXPECT_NEAR(ball.gas().pressure, pressure[k], 1e-3 * pressure[0]) << "reported";
    }
    ASSERT_GT(pressure[0], 100);
    for (int k = 1; k < 4; ++k)
      EXPECT_NEAR(pressure[k], pressure[0], 1e-3 * pressure[0]) << iterations[k] << " iterations, clamped " << clamped;
  }
}

// Drawn at one speed, then held. A step that starts where the motion leads finds only what changes it. That a start is
// dropped where it misleads shows in the pressed scope, see the table of states of contact.
TEST(FewIterationsInMotion, FollowWhatGoesOn) {
  StepSettings settings;
  settings.iterations = 2;
  Ball ball = makeBall(Kind::OnABed, settings);
  const double per_step = 0.03 * settings.step;  // [m]
  int steady = 0, longest = 0;
  for (int i = 1; i <= 60; ++i) {
    ball.run->loads.constraints = {topAt(ball, per_step * std::min(i, 30))};
    const StepOutcome outcome = ball.run->step();
    ASSERT_TRUE(outcome.arrived) << i;
    if (i > 10 && i <= 30) steady += outcome.iterations;
    longest = std::max(longest, outcome.iterations);
  }
  RecordProperty("iterations_per_step", std::to_string(steady / 20.0));
  EXPECT_LE(steady, 2.4 * 20) << "from the present positions it takes 3.35";
  EXPECT_LE(longest, 6);
}

// The last move of a step is not evaluated, if it is the first as well.
TEST(FewIterationsInMotion, TakeOneEvaluationWhereHardlyAnythingMoves) {
  StepSettings settings;
  settings.iterations = 2;
  Ball ball = makeBall(Kind::OnABed, settings);
  int at_once = 0, evaluations = 0;
  for (int i = 1; i <= 200; ++i) {
    ball.run->loads.constraints = {topAt(ball, 1e-3 * minimumJerk(i / 30.0))};
    const StepOutcome outcome = ball.run->step();
    if (i == 15) {
      EXPECT_GE(outcome.evaluations, 2) << "while it moves";
    }
    if (i <= 190) continue;
    at_once += outcome.converged && outcome.iterations == 1 ? 1 : 0;
    evaluations += outcome.evaluations;
  }
  EXPECT_EQ(at_once, 10);
  EXPECT_LE(evaluations, 12) << "with every end evaluated it is 20";
}

}  // namespace
}  // namespace vibe::few_iterations_test
