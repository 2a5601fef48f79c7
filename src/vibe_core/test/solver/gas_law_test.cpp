#include "solver/potential.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "solver/balloon.hpp"

namespace vibe::gas_law_test {
namespace {

using test::Ball;

GasLoad insufflator(double flow) {
  GasLoad gas;
  gas.control = GasLoad::Control::Regulated;
  gas.set_pressure = 1000;
  gas.volume = 1e-3;
  gas.amount = (gas.ambient + gas.set_pressure) * gas.volume;
  gas.amount_min = gas.amount - flow;
  gas.amount_max = gas.amount + flow;
  return gas;
}

TEST(GasLaw, PressureIsTheNegativeSlopeOfAConvexEnergy) {
  const GasLoad load = insufflator(5);
  const GasLaw law(load);
  double before = law.pressure(0.5e-3);
  for (double volume = 0.5e-3; volume < 2e-3; volume += 1.1e-6) {
    const double d = 1e-9;
    EXPECT_NEAR((law.energy(volume - d) - law.energy(volume + d)) / (2 * d), law.pressure(volume), 0.1);
    EXPECT_LE(law.pressure(volume), before);
    before = law.pressure(volume);
  }
}

TEST(GasLaw, KeepsTheSetPointWithinTheAmounts) {
  const GasLoad load = insufflator(5);
  const GasLaw law(load);
  const double absolute = load.ambient + load.set_pressure;
  EXPECT_EQ(law.pressure(load.volume), 1000);
  EXPECT_EQ(law.stiffness(load.volume), 0);
  EXPECT_EQ(law.pressure(0.999 * load.amount_max / absolute), 1000);
  const double large = 1.1 * load.amount_max / absolute, small = 0.9 * load.amount_min / absolute;
  EXPECT_DOUBLE_EQ(law.pressure(large), load.amount_max / large - load.ambient);
  EXPECT_DOUBLE_EQ(law.stiffness(large), load.amount_max / (large * large));
  EXPECT_DOUBLE_EQ(law.pressure(small), load.amount_min / small - load.ambient);
  EXPECT_DOUBLE_EQ(law.stiffness(small), load.amount_min / (small * small));
}

TEST(GasLaw, AmountsWithinTheStepAreInterpolated) {
  const GasLoad load = insufflator(8);
  const GasLaw half(load, 0.5);
  const double large = 2e-3;
  EXPECT_NEAR(half.pressure(large), (load.amount + 4) / large - load.ambient, 1e-6);
}

TEST(GasLaw, WithoutFlowItIsAClosedGas) {
  GasLoad closed = insufflator(0);
  const GasLaw regulated(closed);
  GasLoad amount = closed;
  amount.control = GasLoad::Control::Amount;
  const GasLaw law(amount);
  for (double volume : {0.9e-3, 1.0e-3, 1.1e-3}) {
    EXPECT_NEAR(regulated.pressure(volume), law.pressure(volume), 1e-6);
    EXPECT_NEAR(regulated.energy(volume) - regulated.energy(1e-3), law.energy(volume) - law.energy(1e-3), 1e-9);
  }
}

// A ball that is squeezed and let go crosses all pieces of the law, in iterations as well; steps of many iterations say
// what is right.
TEST(GasLaw, IterationsFindThePieceThatActs) {
  const auto squeezed = [](int iterations) {
    StepSettings settings;
    settings.iterations = iterations;
    Ball ball(settings, test::stomachWall());
    ball.fill(1000);
    GasLoad& gas = ball.gas();
    gas.control = GasLoad::Control::Regulated;
    gas.set_pressure = 1000;
    std::vector<double> pressures;
    for (int step = 0; step < 40; ++step) {
      gas.amount_min = gas.amount - 0.4, gas.amount_max = gas.amount + 0.4;
      gas.volume = ball.volume();
      ball.run->loads.constraints.clear();
      const Eigen::Vector3d depth(0.01 * std::sin(0.3 * step), 0, 0);
      ball.run->loads.addPoint({3}, {1}, ball.run->stepper.body().rest[3] + depth, 0);
      ball.run->step();
      pressures.push_back(gas.pressure);
      gas.amount = std::clamp((gas.ambient + 1000) * ball.volume(), gas.amount_min, gas.amount_max);
    }
    return pressures;
  };
  const std::vector<double> two = squeezed(2), twelve = squeezed(12);
  int kept = 0, limited = 0;
  double worst = 0, range = 0;
  for (std::size_t i = 0; i < two.size(); ++i) {
    (twelve[i] == 1000 ? kept : limited) += 1;
    worst = std::max(worst, std::abs(two[i] - twelve[i]));
    range = std::max(range, std::abs(twelve[i] - 1000));
  }
  ::testing::Test::RecordProperty("worst_over_range", std::to_string(worst / range));
  EXPECT_GE(kept, 5);
  EXPECT_GE(limited, 5);
  EXPECT_LT(worst, 0.05 * range);
}

}  // namespace
}  // namespace vibe::gas_law_test
