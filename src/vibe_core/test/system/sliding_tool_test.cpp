// A scope whose tip slides along a wall without friction needs the work that its springs and the wall's dampers lose.
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "vibe_testing/scope_worlds.hpp"

namespace vibe::sliding_tool_test {
namespace {

using test::World;

constexpr double kRadius = 0.06;
constexpr double kCircle = 0.0346;  // of the tip about the axis of the ball [m]
constexpr double kWay = 0.03;       // of the tip [m]
constexpr double kToWall = 7.3e-3;  // from the axis of the tip to the mid-surface [m]

/// The bent tip presses the wall of a ball on a foundation, beside its axis.
World pressingWorld(int rate, bool yields, StepInput& input) {
  Scene scene = test::shellUnderScope(kRadius);
  scene.step_period = 1.0 / rate;
  scene.scope->compliance.reset();
  if (yields) scene.scope->compliance.emplace();
  scene.scope->friction = 0;
  World world = test::scopeWorld(scene, test::openBall(kRadius, 4, 2e-3));  // 4.6 mm between particles
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

class ToAndFro : public ::testing::TestWithParam<std::tuple<int, bool>> {};

// What the contacts give the tool, because their normals are those of the moment at which the wall resists, the time
// scheme of the wall takes.
TEST_P(ToAndFro, WithoutFrictionTakesTheWorkThatIsLost) {
  StepInput input;
  const auto [rate, yields] = GetParam();
  World world = pressingWorld(rate, yields, input);
  const auto stored = [&world] {
    const auto& springs = world.model->scope_springs;
    return springs ? springs->energy(world.state.joints, world.state.tool_displacement) : 0;
  };
  const EnergyAccount before = world.state.energy;
  const double stored_before = stored();
  double force = 0;
  long steps = 0;
  const auto add = [&] { force += world.state.tool_force.norm(), ++steps; };
  turn(world, input, kWay / kCircle, 1, add);
  turn(world, input, -kWay / kCircle, 1, add);
  force /= static_cast<double>(steps);
  ASSERT_GT(force, 0.3);
  const EnergyAccount& after = world.state.energy;
  const double hand = after.hand_work - before.hand_work, tool = after.tool_work - before.tool_work,
               lost = after.scope_loss - before.scope_loss + after.damping_loss - before.damping_loss;
  // per step the tangent at its end comes nearer to a round tip by way^2 / (2 radius)
  const double way_of_step = 2 * kWay / static_cast<double>(steps);
  const double of_tangents = force * 2 * kWay * way_of_step / (2 * kToWall);
  EXPECT_GE(hand, 0) << "J; contact drives the tip";
  EXPECT_NEAR(hand, lost, 0.05 * of_tangents) << "J; with normals of the middle or the end of the step: 0.4 or more";
  const double of_scope = after.scope_loss - before.scope_loss + stored() - stored_before;
  EXPECT_NEAR(hand, tool + of_scope, 0.01 * of_tangents) << "levers are those of the middle of the step";
}

INSTANTIATE_TEST_SUITE_P(Rates, ToAndFro, ::testing::Combine(::testing::Values(60, 240), ::testing::Bool()));

}  // namespace
}  // namespace vibe::sliding_tool_test
