#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "vibe_firmware/core/passivity.hpp"

namespace vibe_firmware::passivity_conditions_test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

AxisParameters spring(float stiffness, float damping) {
  AxisParameters parameters;
  parameters.stiffness = stiffness;
  parameters.damping = damping;
  parameters.torque_limit = 0.02F;
  return parameters;
}

TEST(PassivityConditions, AreTheFormulas) {
  AxisConfig config;  // T = 1 ms, t_d = 0.05 ms, a = 0.9, D = 3.07e-4
  config.safety_factor = 2;
  const double g = 0.1 / 1.9;
  const double h = 0.5 + 0.05 + std::sqrt(0.25 + 2 * 0.05);
  EXPECT_NEAR(requiredViscousFriction(config, 0.3F, 2e-3F), 2 * h * (0.3 * 1e-3 / 2 + g * 2e-3), 1e-9);
  EXPECT_NEAR(requiredCoulombFriction(config, 0.3F, 2e-3F), 2 * 3.07e-4 * (0.15 + 0.1 * 2), 1e-9);
  config.radians_per_count = -config.radians_per_count;
  EXPECT_NEAR(requiredCoulombFriction(config, 0.3F, 2e-3F), 2 * 3.07e-4 * (0.15 + 0.1 * 2), 1e-9);
}

// The proof of the condition of quantisation: no sequence of positions makes the filtered velocity more wrong. The
// worst one has its error at one end until the last step, and then at the other.
TEST(PassivityConditions, TheErrorOfTheFilteredVelocityIsBounded) {
  for (const double a : {0.0, 0.5, 0.9}) {
    double v = 0;  // at the end
    const auto filtered = [a, &v](auto error) {
      double largest = 0;
      v = 0;
      for (int k = 1; k < 400; ++k) {
        v = a * v + (1 - a) * (error(k) - error(k - 1));  // in steps of the encoder per period
        largest = std::max(largest, std::abs(v));
      }
      return largest;
    };
    EXPECT_NEAR(filtered([](int k) { return k < 399 ? -0.5 : 0.5; }), 1 - a, 1e-12);
    const auto scattered = [](int k) { return 1664525U * static_cast<unsigned>(k * k + k) / 4294967296.0 - 0.5; };
    EXPECT_LE(filtered(scattered), 1 - a);
    filtered([](int k) { return k % 2 - 0.5; });
    EXPECT_NEAR(std::abs(v), (1 - a) / (1 + a), 1e-9) << "the worst motion that is known: it alternates";
  }
}

TEST(PassivityConditions, LargestStiffnessAndDampingAreAcceptedAndOnePercentMoreIsNot) {
  for (const float pole : {0.0F, 0.5F, 0.9F})
    for (const float coulomb : {2e-5F, 8e-4F})
      for (const float share : {0.0F, 0.1F, 0.5F, 0.9F, 0.999F}) {
        AxisConfig config;
        config.velocity_pole = pole;
        config.coulomb_friction = coulomb;
        const float damping = share * maxDamping(config, 0);
        const float stiffness = maxStiffness(config, damping);
        ASSERT_GT(stiffness, 0);
        EXPECT_EQ(validate(config, spring(stiffness, damping)).refusal, Refusal::None);
        EXPECT_NE(validate(config, spring(stiffness + 0.01F * maxStiffness(config, 0), damping)).refusal,
                  Refusal::None);
        const float other = maxDamping(config, share * maxStiffness(config, 0));
        EXPECT_EQ(validate(config, spring(share * maxStiffness(config, 0), other)).refusal, Refusal::None);
        EXPECT_NE(
            validate(config, spring(share * maxStiffness(config, 0), other + 0.01F * maxDamping(config, 0))).refusal,
            Refusal::None);
      }
}

TEST(PassivityConditions, NothingIsPassiveBeyondTheLimit) {
  const AxisConfig config;
  EXPECT_EQ(maxStiffness(config, 2 * maxDamping(config, 0)), 0);
  EXPECT_EQ(maxDamping(config, 2 * maxStiffness(config, 0)), 0);
}

TEST(PassivityConditions, RefusalSaysWhatFailed) {
  AxisConfig config;
  Verdict verdict = validate(config, spring(3, 0));
  EXPECT_EQ(verdict.refusal, Refusal::ViscousFriction);
  EXPECT_FLOAT_EQ(verdict.value, requiredViscousFriction(config, 3, 0));
  EXPECT_EQ(verdict.limit, config.viscous_friction);

  config.coulomb_friction = 1e-5F;
  verdict = validate(config, spring(0.5F, 0));
  EXPECT_EQ(verdict.refusal, Refusal::CoulombFriction);
  EXPECT_FLOAT_EQ(verdict.value, requiredCoulombFriction(config, 0.5F, 0));
  EXPECT_EQ(verdict.limit, config.coulomb_friction);
}

TEST(PassivityConditions, EachKindOfBadValueIsRefused) {
  const AxisConfig config;
  const auto refusal = [&](auto change) {
    AxisParameters parameters = spring(0.1F, 1e-4F);
    change(parameters);
    return validate(config, parameters).refusal;
  };
  EXPECT_EQ(refusal([](AxisParameters&) {}), Refusal::None);
  for (const float bad : {kNan, kInfinity, -kInfinity}) {
    EXPECT_EQ(refusal([=](AxisParameters& p) { p.stiffness = bad; }), Refusal::NotFinite);
    EXPECT_EQ(refusal([=](AxisParameters& p) { p.damping = bad; }), Refusal::NotFinite);
    EXPECT_EQ(refusal([=](AxisParameters& p) { p.position = bad; }), Refusal::NotFinite);
    EXPECT_EQ(refusal([=](AxisParameters& p) { p.torque = bad; }), Refusal::NotFinite);
    EXPECT_EQ(refusal([=](AxisParameters& p) { p.torque_limit = bad; }), Refusal::NotFinite);
  }
  EXPECT_EQ(refusal([](AxisParameters& p) { p.stiffness = -1e-6F; }), Refusal::Negative);
  EXPECT_EQ(refusal([](AxisParameters& p) { p.damping = -1e-6F; }), Refusal::Negative);
  EXPECT_EQ(refusal([](AxisParameters& p) { p.torque_limit = -1e-6F; }), Refusal::Negative);
  EXPECT_EQ(refusal([](AxisParameters& p) { p.torque_limit = 0.0291F; }), Refusal::TorqueLimit);
  EXPECT_EQ(refusal([](AxisParameters& p) { p.torque = -0.0291F; }), Refusal::TorqueLimit);
  EXPECT_EQ(refusal([](AxisParameters& p) { p.position = 6000; }), Refusal::Position);
  EXPECT_EQ(refusal([](AxisParameters& p) { p.stiffness = 3e38F; }), Refusal::ViscousFriction);
}

TEST(PassivityConditions, AxisWithoutFrictionAcceptsOnlyStaticTorque) {
  AxisConfig config;
  config.viscous_friction = 0;
  config.coulomb_friction = 0;
  EXPECT_EQ(validate(config, spring(0, 0)).refusal, Refusal::None);
  EXPECT_EQ(validate(config, spring(1e-6F, 0)).refusal, Refusal::ViscousFriction);
}

TEST(PassivityConditions, VerdictNamesTheAxis) {
  const std::array<AxisConfig, kAxisCount> configs{};
  EXPECT_EQ(validate(configs, {spring(0.1F, 0), spring(9, 0)}).axis, 1);
  EXPECT_EQ(validate(configs, {spring(9, 0), spring(9, 0)}).axis, 0);
  EXPECT_EQ(validate(configs, {spring(0.1F, 0), spring(0.1F, 0)}).refusal, Refusal::None);
}

}  // namespace
}  // namespace vibe_firmware::passivity_conditions_test
