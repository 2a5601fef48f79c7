// The set point of the insufflator is reached once, not whenever the tool disturbs the pressure.
#include "procedure/procedure.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "vibe_core/simulation/simulation.hpp"
#include "vibe_testing/worlds.hpp"

namespace vibe::set_point_test {
namespace {

constexpr double kSetPoint = 1300;  // [Pa]

TEST(SetPoint, IsReachedNearAndLostFarther) {
  EXPECT_FALSE(isAtSetPoint(0.985 * kSetPoint, kSetPoint, false));
  EXPECT_TRUE(isAtSetPoint(0.995 * kSetPoint, kSetPoint, false));
  EXPECT_TRUE(isAtSetPoint(1.005 * kSetPoint, kSetPoint, false));
  EXPECT_FALSE(isAtSetPoint(1.015 * kSetPoint, kSetPoint, false));
  EXPECT_TRUE(isAtSetPoint(0.96 * kSetPoint, kSetPoint, true));
  EXPECT_TRUE(isAtSetPoint(1.04 * kSetPoint, kSetPoint, true));
  EXPECT_FALSE(isAtSetPoint(0.94 * kSetPoint, kSetPoint, true));
  EXPECT_FALSE(isAtSetPoint(1.06 * kSetPoint, kSetPoint, true));
}

TEST(SetPoint, OfNoPressureHasABandToo) {
  EXPECT_TRUE(isAtSetPoint(0.5, 0, false));
  EXPECT_FALSE(isAtSetPoint(2, 0, false));
  EXPECT_TRUE(isAtSetPoint(2, 0, true));
  EXPECT_FALSE(isAtSetPoint(6, 0, true));
}

/// A ball with an insufflator that is too slow to make up for a disturbance.
std::shared_ptr<const Model> ball() {
  Scene scene = test::bareScene();
  scene.tissue.young_modulus = 1e7;
  scene.tissue.mass_damping = 50;
  scene.foundation = FoundationScene{};
  scene.gas = GasScene{};
  scene.gas->initial_pressure = 0;
  scene.gas->regulated_pressure = kSetPoint;
  scene.gas->insufflator_on = true;
  scene.gas->flow_limit = 1e-9;
  return test::World(scene, test::plainOrgan(test::icosphere(0.05, 2), 2e-3)).model;
}

/// Adds or takes gas until the pressure is a part of the set point.
/// @return how often the set point was reached
int bringTo(double part, Simulation& simulation) {
  int reached = 0;
  const double wanted = part * kSetPoint;
  for (int k = 0; k < 1000 && std::abs(simulation.state().pressure - wanted) > 0.002 * kSetPoint; ++k) {
    State& state = simulation.editState();
    state.gas_amount += 0.2 * (wanted - state.pressure) * state.volume;
    for (const Event& event : simulation.step()) reached += event.kind == Event::Kind::PressureReached ? 1 : 0;
  }
  EXPECT_NEAR(simulation.state().pressure, wanted, 0.002 * kSetPoint);
  return reached;
}

TEST(SetPoint, ADisturbanceCausesNoFurtherEvent) {
  Simulation simulation(ball());
  EXPECT_EQ(bringTo(0.9, simulation), 0);
  EXPECT_EQ(bringTo(1, simulation), 1);
  for (int k = 0; k < 5; ++k)
    for (const double part : {0.97, 1.0, 1.03, 1.0}) {
      EXPECT_EQ(bringTo(part, simulation), 0);
      EXPECT_TRUE(simulation.state().pressure_reached);
    }
}

TEST(SetPoint, IsReachedAgainAfterGasWasLost) {
  Simulation simulation(ball());
  EXPECT_EQ(bringTo(1, simulation), 1);
  EXPECT_EQ(bringTo(0.9, simulation), 0);
  EXPECT_FALSE(simulation.state().pressure_reached);
  EXPECT_EQ(bringTo(0.97, simulation), 0) << "nearer, but not there";
  EXPECT_EQ(bringTo(1, simulation), 1);
}

}  // namespace
}  // namespace vibe::set_point_test
