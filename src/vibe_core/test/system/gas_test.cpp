// The balloon on paper: a membrane of modulus K = E t / (1 - nu) per length on a sphere stretched by e carries
//   p = 2 K e / (R (1 + e)^2).
#include "vibe_core/constraints/gas.hpp"

#include <gtest/gtest.h>

#include "geometry/surface_operators.hpp"
#include "vibe_core/model/accounting.hpp"
#include "vibe_testing/worlds.hpp"

namespace vibe::gas_test {
namespace {

using test::bareScene;
using test::icosphere;
using test::plainOrgan;
using test::World;

constexpr double kRadius = 0.05;
constexpr double kThickness = 2e-3;

Scene balloonScene(double pressure) {
  Scene scene = bareScene();
  scene.tissue.substeps = 40;
  scene.tissue.mass_damping = 30;
  scene.gas = GasScene{};
  scene.gas->regulated_pressure = pressure;
  scene.gas->flow_limit = 1e-2;
  scene.gas->insufflator_on = true;
  return scene;
}

double membranePressure(const World& world) {
  const TissueScene& t = world.model->scene.tissue;
  const double modulus = t.young_modulus * kThickness / (1 - t.poisson_ratio);
  const double stretch = std::cbrt(world.state.volume / world.model->rest_volume) - 1;
  return 2 * modulus * stretch / (kRadius * (1 + stretch) * (1 + stretch));
}

TEST(Gas, BalloonObeysTheMembraneFormula) {
  for (double pressure : {200.0, 500.0, 1000.0}) {
    World world(balloonScene(pressure), plainOrgan(icosphere(kRadius, 3), kThickness));
    ASSERT_EQ(world.model->tissue->stiffnessRatio(), 1.0);
    world.run(3.0);
    EXPECT_NEAR(world.state.pressure, pressure, 1e-6 * pressure);
    EXPECT_NEAR(membranePressure(world) / pressure, 1, 0.01);
    EXPECT_EQ(world.count(Event::Kind::PressureReached), 1);
  }
}

TEST(Gas, EquilibriumDoesNotDependOnTheSubstep) {
  double volumes[2];
  for (int k = 0; k < 2; ++k) {
    Scene scene = balloonScene(800);
    scene.tissue.substeps = k == 0 ? 30 : 120;
    World world(scene, plainOrgan(icosphere(kRadius, 3), kThickness));
    ASSERT_EQ(world.model->tissue->stiffnessRatio(), 1.0);
    world.run(3.0);
    volumes[k] = world.state.volume - world.model->rest_volume;
  }
  EXPECT_NEAR(volumes[0] / volumes[1], 1, 2e-3);
}

TEST(Gas, VolumeInTheStateIsThatOfTheSurface) {
  World world(balloonScene(600), plainOrgan(icosphere(kRadius, 2), kThickness));
  world.run(2.0);
  EXPECT_NEAR(lumenVolume(world.model->organ.surface, world.state.x, world.state.y, world.state.z), world.state.volume,
              1e-6 * world.state.volume);
}

TEST(Gas, ClosedAmountIsIsothermal) {
  Scene scene = balloonScene(600);
  scene.gas->insufflator_on = false;
  scene.gas->initial_pressure = 400;
  World world(scene, plainOrgan(icosphere(kRadius, 2), kThickness));
  const double amount = world.state.gas_amount;
  EXPECT_DOUBLE_EQ(amount, (kAmbientPressure + 400) * world.model->rest_volume);
  world.run(1.0);
  EXPECT_EQ(world.state.gas_amount, amount);
  EXPECT_NEAR((kAmbientPressure + world.state.pressure) * world.state.volume, amount, 1e-9 * amount);
  EXPECT_GT(world.state.volume, world.model->rest_volume);
  EXPECT_LT(world.state.pressure, 400);
}

TEST(Gas, InsufflatorFlowIsLimited) {
  Scene scene = balloonScene(3000);
  scene.gas->flow_limit = 5e-5;
  scene.gas->insufflator_on = false;
  World world(scene, plainOrgan(icosphere(kRadius, 2), kThickness));
  const double amount = world.state.gas_amount;
  StepInput pressed;
  pressed.buttons[Insufflate] = 1;
  world.run(0.5, pressed);
  EXPECT_NEAR(world.state.gas_amount - amount, 5e-5 * kAmbientPressure * 0.5, 1e-9);
  world.run(0.5);
  EXPECT_NEAR(world.state.gas_amount - amount, 5e-5 * kAmbientPressure * 0.5, 1e-9) << "it is off";
}

TEST(Gas, EnergyBalanceHolds) {
  Scene scene = balloonScene(500);
  scene.gravity = GravityScene{};
  scene.foundation = FoundationScene{};
  scene.foundation->carries_weight = false;
  World world(scene, plainOrgan(icosphere(kRadius, 3), kThickness));
  const double before = energyBalance(*world.model, world.state);
  world.run(2.0);
  EXPECT_GT(world.state.energy.gas_work, 1e-2);
  EXPECT_NEAR(energyBalance(*world.model, world.state), before, 2e-3 * world.state.energy.gas_work);
}

// The implicit solver has the pressure of the end of a step, not that of the volume at its start.
TEST(Gas, PressureFollowsWithinTheStep) {
  Scene scene = balloonScene(1000);
  scene.tissue.model = "shell";
  scene.foundation = FoundationScene{};
  scene.gas->flow_limit = 1e-3;
  World world(scene, plainOrgan(icosphere(kRadius, 3), kThickness));
  world.run(2.0);
  ASSERT_NEAR(world.state.pressure, 1000, 1e-6);
  const double volume = world.state.volume;
  StepInput pull;
  pull.pull_particle = 12;
  pull.pull_target = world.position(12) * 0.4;
  double most = 0;
  for (int i = 0; i < 30; ++i) {
    const double before = world.state.gas_amount;
    world.step(pull);
    EXPECT_NEAR(world.state.pressure, 1000, 1e-6) << "step " << i;
    most = std::max(most, std::abs(world.state.gas_amount - before));
  }
  EXPECT_LT(world.state.volume, 0.99 * volume) << "it would have been 1 kPa above its set point";
  EXPECT_LT(most, 1e-3 * kAmbientPressure * scene.step_period);
}

TEST(Gas, LawsOnPaper) {
  EXPECT_DOUBLE_EQ(gaugePressure(gasAmount(1234, 2e-3), 2e-3), 1234);
  EXPECT_TRUE(std::isfinite(gaugePressure(1, 0)));
  GasScene gas;
  gas.regulated_pressure = 1000;
  gas.flow_limit = 1e-4;
  const double amount = gasAmount(2000, 1e-3);  // above the set point: it lets gas out
  EXPECT_LT(insufflate(gas, amount, 1e-3, 1e-3), amount);
  EXPECT_DOUBLE_EQ(insufflate(gas, amount, 1e-3, 1e9), gasAmount(1000, 1e-3));
}

}  // namespace
}  // namespace vibe::gas_test
