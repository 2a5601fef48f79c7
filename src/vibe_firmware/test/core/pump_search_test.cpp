#include "pump_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "vibe_firmware/core/passivity.hpp"

// Worst-case search over the real control function: no hand gains energy from accepted parameters, some hand does 5 %
// outside of what is necessary. Both are the same but for a filtered damper that the Coulomb friction limits: there the
// condition is 1 + a times stricter than the worst motion that is known. Safety factor 1, no output delay: the limits
// themselves.

namespace vibe_firmware::pump_search_test {
namespace {

struct Hardware {
  const char* name;
  AxisConfig config;
};

AxisConfig bare(float pole) {
  AxisConfig config;
  config.safety_factor = 1;
  config.output_delay = 0;
  config.velocity_pole = pole;
  return config;
}

AxisConfig directDrive() {
  AxisConfig config = bare(0.9F);
  config.radians_per_count *= 10;
  config.viscous_friction /= 100;
  config.coulomb_friction /= 10;
  config.torque_limit /= 10;
  return config;
}

AxisConfig littleCoulomb(float pole) {
  AxisConfig config = bare(pole);
  config.coulomb_friction = 1e-4F;
  config.torque_limit = 1;
  return config;
}

/// Little of both: viscous friction limits stiff springs, Coulomb friction strong dampers.
AxisConfig bothLimits() {
  AxisConfig config = bare(0.9F);
  config.viscous_friction = 2.5e-4F;
  config.coulomb_friction = 1e-4F;
  config.torque_limit = 1;
  return config;
}

AxisConfig mirrored() {
  AxisConfig config = bare(0.9F);
  config.radians_per_count = -config.radians_per_count;
  return config;
}

std::vector<Hardware> hardware() {
  std::vector<Hardware> all = {{"capstan, 17 Hz filter", bare(0.9F)},
                               {"both limits", bothLimits()},
                               {"capstan, no filter", bare(0)},
                               {"capstan, encoder reversed", mirrored()},
                               {"direct drive", directDrive()},
                               {"little Coulomb friction, 17 Hz filter", littleCoulomb(0.9F)},
                               {"little Coulomb friction, 110 Hz filter", littleCoulomb(0.5F)},
                               {"little Coulomb friction, no filter", littleCoulomb(0)}};
#ifdef __SANITIZE_ADDRESS__
  all.resize(2);  // ten times slower
#endif
  return all;
}

bool slow() {
  return std::getenv("VIBE_SLOW_TESTS") != nullptr;
}

/// Narrow motions show quantisation, wide ones sampling.
std::vector<Lattice> lattices() {
  if (slow()) return {{4, 1, 325}, {5, 1, 401}, {4, 8, 325}, {4, 24, 325}, {6, 16, 401}, {3, 40, 325}, {2, 70, 325}};
  return {{3, 1, 127}, {4, 24, 163}, {3, 40, 127}};
}

/// One result per lattice.
std::vector<PumpResult> search(const AxisConfig& config, float stiffness, float damping) {
  AxisParameters parameters;
  parameters.stiffness = stiffness;
  parameters.damping = damping;
  parameters.torque_limit = config.torque_limit;
  std::vector<PumpResult> results;
  for (const Lattice& lattice : lattices()) results.push_back(PumpSearch(config, parameters, lattice).run());
  return results;
}

double largestGain(const std::vector<PumpResult>& results) {
  double gain = 0;
  for (const PumpResult& result : results) gain = std::max(gain, result.gain);
  return gain;
}

/// Points of the boundary: shares of the largest damping.
std::vector<float> shares() {
  if (slow()) return {0, 0.05F, 0.1F, 0.2F, 0.3F, 0.4F, 0.5F, 0.6F, 0.7F, 0.8F, 0.9F, 0.95F, 1};
  return {0, 0.3F, 0.6F, 0.9F, 1};
}

/// Point of the boundary, times `scale`.
std::vector<PumpResult> searchAt(const AxisConfig& config, float share, float scale) {
  const float damping = share * maxDamping(config, 0);
  return search(config, scale * maxStiffness(config, damping), scale * damping);
}

/// Point 5 % beyond the boundary of what is necessary: f_c >= D (K/2 + g B/T).
std::vector<PumpResult> searchOutside(const AxisConfig& config, float share) {
  const float period = config.sample_period, step = std::fabs(config.radians_per_count);
  const float g = (1 - config.velocity_pole) / (1 + config.velocity_pole);
  const auto within = [&](float damping) {
    return 2 * std::min(config.viscous_friction / period - g * damping / period,
                        config.coulomb_friction / step - g * damping / period);
  };
  const float damping = share * std::min(config.viscous_friction, config.coulomb_friction / step * period) / g;
  return search(config, 1.05F * std::max(within(damping), 0.0F), 1.05F * damping);
}

TEST(PumpSearch, NoHandGainsEnergyFromAcceptedParameters) {
  for (const Hardware& axis : hardware())
    for (const float share : shares())
      for (const float inside : {1.0F, 0.5F})
        EXPECT_EQ(largestGain(searchAt(axis.config, share, inside)), 0)
            << axis.name << ", B " << share << " of the largest, times " << inside;
}

TEST(PumpSearch, SomeHandGainsEnergyFivePercentOutside) {
  for (const Hardware& axis : hardware())
    for (const float share : shares())
      EXPECT_GT(largestGain(searchOutside(axis.config, share)), 0) << axis.name << ", B " << share << " of the largest";
}

// The upper bound, too: where 5 % outside is active, it grows less than a hundredth as fast on the boundary.
TEST(PumpSearch, UpperBoundDoesNotGrowOnTheBoundary) {
  for (const Hardware& axis : hardware())
    for (const float share : {0.0F, 0.6F, 1.0F}) {
      const std::vector<PumpResult> outside = searchOutside(axis.config, share);
      const std::vector<PumpResult> boundary = searchAt(axis.config, share, 1);
      for (std::size_t i = 0; i < outside.size(); ++i) {
        if (outside[i].gain <= 0) continue;
        EXPECT_LT(boundary[i].bound, 0.01 * outside[i].bound)
            << axis.name << ", B " << share << " of the largest, stride " << lattices()[i].stride;
      }
    }
}

TEST(PumpSearch, TorqueLimitLeavesTheAxisPassive) {
  for (const float torque_limit : {0.02F, 0.005F, 0.001F})
    for (const float share : {0.0F, 0.5F, 1.0F}) {
      AxisConfig config = bare(0.9F);
      config.torque_limit = torque_limit;
      EXPECT_EQ(largestGain(searchAt(config, share, 1)), 0)
          << "torque limit " << torque_limit << ", B " << share << " of the largest";
    }
}

TEST(PumpSearch, GainAgreesWithTheFormulaOfTheWorstMotion) {
  // spring 10 % too stiff, back and forth between the inner edges of the outermost cells: dF X/2 - b X^2/T - f_c X
  AxisConfig config = bare(0);
  config.torque_limit = 10;
  AxisParameters parameters;
  parameters.stiffness = 1.1F * maxStiffness(config, 0);
  parameters.torque_limit = 10;
  const Lattice lattice{2, 50, 101};
  const double step = config.radians_per_count;
  const double motion = (200 - 1 + 2e-3) * step;
  const double jump = parameters.stiffness * 200 * step;  // of the torque
  const double expected =
      0.5 * jump * motion - config.viscous_friction * motion * motion / 1e-3 - config.coulomb_friction * motion;
  const PumpResult result = PumpSearch(config, parameters, lattice).run();
  EXPECT_GT(result.gain, 0);
  EXPECT_NEAR(result.gain, expected, 0.01 * expected);
}

}  // namespace
}  // namespace vibe_firmware::pump_search_test
