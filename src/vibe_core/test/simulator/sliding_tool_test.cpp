// A rigid scope whose tip slides along a wall without friction: it needs no less work than nothing, at any step, and on
// a ball that it circles its force stays the same.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "vibe_testing/scope_worlds.hpp"

namespace vibe::sliding_tool_test {
namespace {

using test::World;

constexpr double kRadius = 0.06;
constexpr double kCircle = 0.0346;  // of the tip about the axis of the ball [m]
constexpr double kWay = 0.03;       // of the tip [m]
constexpr double kToWall = 7.3e-3;  // from the axis of the tip to the mid-surface [m]

/// The bent tip presses the wall of a ball on a foundation, beside its axis.
World pressingWorld(int rate, int level, StepInput& input) {
  Scene scene;
  scene.step_period = 1.0 / rate;
  scene.tissue.model = "shell";
  scene.tissue.mass_damping = 30;
  scene.tissue.self_contact = false;
  scene.gas.reset();
  scene.gravity.reset();
  scene.foundation = FoundationScene{};
  scene.foundation->stiffness = 2e5;
  scene.scope = test::scopeFromAbove(kRadius);
  scene.scope->compliance.reset();
  scene.scope->friction = 0;
  World world = test::scopeWorld(scene, test::openBall(kRadius, level, 2e-3));
  input.joints[Insertion] = 0.122;
  input.joints[TipUpDown] = 0.6;
  world.run(2.5, input);
  return world;
}

/// Turns the scope, and with it the tip along its circle, from one angle to another.
template <class Each>
void turn(World& world, StepInput& input, double by, double seconds, Each each) {
  const double from = input.joints[Rotation];
  const long steps = std::lround(seconds / world.model->scene.step_period);
  for (long i = 1; i <= steps; ++i) {
    input.joints[Rotation] = from + by * static_cast<double>(i) / static_cast<double>(steps);
    world.step(input);
    each();
  }
}

class ToAndFro : public ::testing::TestWithParam<int> {};

TEST_P(ToAndFro, WithoutFrictionTakesNoWorkFromTheWall) {
  StepInput input;
  World world = pressingWorld(GetParam(), 4, input);
  const EnergyAccount before = world.state.energy;
  double force = 0;
  long steps = 0;
  const auto add = [&] { force += world.state.tool_force.norm(), ++steps; };
  turn(world, input, kWay / kCircle, 1, add);
  turn(world, input, -kWay / kCircle, 1, add);
  force /= static_cast<double>(steps);
  ASSERT_GT(force, 0.3);
  const EnergyAccount& after = world.state.energy;
  const double hand = after.hand_work - before.hand_work, tool = after.tool_work - before.tool_work,
               sliding = after.friction_loss - before.friction_loss;
  // per step the tangent at its end comes nearer to a round tip by way^2 / (2 radius)
  const double way_of_step = 2 * kWay / static_cast<double>(steps);
  const double of_tangents = force * 2 * kWay * way_of_step / (2 * kToWall);
  EXPECT_GE(sliding, 0);
  EXPECT_LT(sliding, 0.1 * of_tangents);
  EXPECT_GE(hand, 0);
  EXPECT_NEAR(hand, tool, 0.01 * of_tangents) << "levers are those of the middle of the step";
}

INSTANTIATE_TEST_SUITE_P(Rates, ToAndFro, ::testing::Values(60, 240));

/// Ripple of the force on a tip that circles at 20 mm/s, rms over the mean [1].
double rippleOn(int level) {
  StepInput input;
  World world = pressingWorld(60, level, input);
  turn(world, input, 0.2, 0.5, [] {});
  std::vector<double> force;
  turn(world, input, kWay / kCircle, 1.5, [&] { force.push_back(world.state.tool_force.norm()); });
  double mean = 0, square = 0;
  for (const double f : force) mean += f / static_cast<double>(force.size());
  for (const double f : force) square += (f - mean) * (f - mean) / static_cast<double>(force.size());
  return std::sqrt(square) / mean;
}

TEST(Circling, FeelsLittleOfTheMesh) {
  EXPECT_LT(rippleOn(4), 0.006) << "4.6 mm between vertices; with contacts at vertices alone 0.011";
  EXPECT_GT(rippleOn(3), 0.006) << "9 mm between vertices: the measure sees a mesh";
}

}  // namespace
}  // namespace vibe::sliding_tool_test
