// The mechanics of an axis against closed forms.
#include "vibe_hardware/emulator/axis_plant.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace vibe::hardware::axis_plant_test {
namespace {

constexpr double kTick = 1e-3;

/// Without friction of any kind.
AxisPlant smoothPlant() {
  AxisPlant plant;
  plant.drive = Drive::Torque;
  plant.motor.friction = 0;
  return plant;
}

double balance(const AxisPlant& plant, const AxisPlantState& s) {
  return s.energy.motor + s.energy.hand - s.energy.viscous - s.energy.coulomb - kineticEnergy(plant, s);
}

TEST(AxisPlant, FreeResponseOfTheHandIsTheDampedOscillator) {
  AxisPlant plant = smoothPlant();
  plant.hand = handOnSlide(0.2, 4, 500, 0.01);
  const double m = totalInertia(plant), k = plant.hand.stiffness, d = plant.hand.damping / (2 * m);
  const double w = std::sqrt(k / m - d * d);
  AxisPlantState state;
  state.position = 0.3;
  for (int i = 1; i <= 300; ++i) {
    step(plant, 0, 0, kTick, state);
    const double t = kTick * i;
    const double expected = 0.3 * std::exp(-d * t) * (std::cos(w * t) + d / w * std::sin(w * t));
    ASSERT_NEAR(state.position, expected, 0.3 * 2e-5) << t;
  }
}

TEST(AxisPlant, ATorqueAgainstBackEmfReachesTheSpeedOfTheDataSheet) {
  AxisPlant plant;
  plant.motor.friction = 0;
  AxisPlantState state;
  const double b = viscousFriction(plant), tau = totalInertia(plant) / b;
  EXPECT_NEAR(b, 6.68e-4, 1e-6);
  for (int i = 1; i <= 200; ++i) {
    step(plant, 0.02, 0, kTick, state);
    // the torque starts 50 us late
    const double t = kTick * i - plant.output_delay;
    ASSERT_NEAR(state.velocity, 0.02 / b * (1 - std::exp(-t / tau)), 1e-4 * 0.02 / b);
  }
}

TEST(AxisPlant, TheSupplyLimitsTheTorqueOfAVoltageDrive) {
  AxisPlant plant;
  AxisPlantState state;
  step(plant, 1, 0, kTick, state);
  EXPECT_NEAR(state.torque, 10 * 11.5e-3 * 9 / 19.8, 1e-9);
  EXPECT_NEAR(state.torque, 0.052, 5e-4);
  plant.drive = Drive::Torque;
  step(plant, 1, 0, kTick, state);
  EXPECT_EQ(state.torque, 1);
}

TEST(AxisPlant, CoulombFrictionStopsItAfterTheDistanceOfTheClosedForm) {
  AxisPlant plant = smoothPlant();
  plant.coulomb = 8e-4;
  AxisPlantState state;
  state.velocity = 2;
  for (int i = 0; i < 100; ++i) step(plant, 0, 0, kTick, state);
  EXPECT_EQ(state.velocity, 0);
  const double distance = 0.5 * totalInertia(plant) * 4 / 8e-4;
  EXPECT_NEAR(state.position, distance, 2 * plant.substep * plant.substep * 8e-4 / totalInertia(plant));
}

TEST(AxisPlant, StaysWhereItIsBelowTheFriction) {
  AxisPlant plant;
  AxisPlantState state;
  for (int i = 0; i < 10000; ++i) step(plant, 0.999 * coulombFriction(plant), 0, kTick, state);
  EXPECT_EQ(state.position, 0);
  step(plant, 1.001 * coulombFriction(plant), 0, kTick, state);
  EXPECT_GT(state.position, 0);
}

// A hand that moves on slowly and pulls through a spring: the shaft sticks until the spring has the force of friction
// at rest, and slips until the spring is as much too short: twice the difference of the frictions over the stiffness.
TEST(AxisPlant, SticksAndSlipsByTheLengthOfTheClosedForm) {
  AxisPlant plant = smoothPlant();
  plant.coulomb = 4e-3;
  plant.breakaway = 1.5;
  plant.hand.stiffness = 0.05;
  AxisPlantState state;
  const double speed = 0.01, slip = 2 * (0.5 * 4e-3) / 0.05;
  double intended = 0, before = 0;
  std::vector<double> slips;
  for (int i = 0; i < 60000; ++i) {
    const bool moved = state.velocity != 0;
    step(plant, 0, intended += speed * kTick, kTick, state);
    if (!moved || state.velocity != 0) continue;
    slips.push_back(state.position - before);
    before = state.position;
  }
  ASSERT_GE(slips.size(), 4U);
  for (const double length : slips) EXPECT_NEAR(length, slip, 0.02 * slip);
  EXPECT_NEAR(slips.front(), slip, 0.02 * slip);
}

TEST(AxisPlant, BalancesItsEnergy) {
  AxisPlant plant;
  plant.viscous = 1e-4;
  plant.breakaway = 1.3;
  plant.hand = handOnSlide(0.2, 5, 500, 0.01);
  AxisPlantState state;
  for (int i = 0; i < 20000; ++i) {
    const double t = kTick * i;
    step(plant, 0.02 * std::sin(9 * t), 3 * std::sin(2 * t) * std::sin(31 * t), kTick, state);
    ASSERT_NEAR(balance(plant, state), 0, 1e-12 * i);
  }
  EXPECT_GT(state.energy.coulomb, 1e-3);
  EXPECT_GT(state.energy.viscous, 1e-3);
  EXPECT_GT(std::abs(state.energy.motor), 1e-4);
}

TEST(AxisPlant, TheEncoderRoundsDown) {
  AxisPlant plant;
  AxisPlantState state;
  state.position = 2.5 * plant.encoder_step;
  EXPECT_EQ(encoderCount(plant, state), 2);
  state.position = -0.5 * plant.encoder_step;
  EXPECT_EQ(encoderCount(plant, state), -1);
}

TEST(AxisPlant, EqualStatesHaveEqualFutures) {
  AxisPlant plant;
  plant.hand = handOnSlide(0.2, 5, 500, 0.01);
  AxisPlantState a;
  for (int i = 0; i < 100; ++i) step(plant, 0.01, 0.1 * i, kTick, a);
  AxisPlantState b = a;
  for (int i = 0; i < 100; ++i) {
    step(plant, -0.01, 3, kTick, a);
    step(plant, -0.01, 3, kTick, b);
  }
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.energy.hand, b.energy.hand);
}

}  // namespace
}  // namespace vibe::hardware::axis_plant_test
