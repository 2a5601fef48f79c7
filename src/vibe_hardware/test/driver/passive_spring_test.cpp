#include "vibe_hardware/driver/joint_scale.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "vibe_firmware/core/passivity.hpp"

namespace vibe::hardware::passive_spring_test {
namespace {

using vibe_firmware::AxisConfig;
using vibe_firmware::AxisParameters;
using vibe_firmware::Refusal;

double torqueAt(const AxisParameters& p, double x) {
  return std::clamp<double>(p.torque - p.stiffness * (x - p.position), -p.torque_limit, p.torque_limit);
}

TEST(PassiveSpring, LeavesWhatIsPassiveAsItIs) {
  const PassiveSpring result = passiveSpring(AxisConfig(), {0.5, 0.01, 0.1, 1e-3, 0.2});
  EXPECT_FALSE(result.clamped);
  EXPECT_FLOAT_EQ(result.parameters.stiffness, 0.1F);
  EXPECT_FLOAT_EQ(result.parameters.damping, 1e-3F);
  EXPECT_FLOAT_EQ(result.parameters.position, 0.5F);
  EXPECT_FLOAT_EQ(result.parameters.torque, 0.01F + 1e-3F * 0.2F);
  EXPECT_EQ(result.parameters.torque_limit, AxisConfig().torque_limit);
}

TEST(PassiveSpring, StiffnessHasPriorityOverDamping) {
  const AxisConfig axis;
  const float largest = vibe_firmware::maxStiffness(axis, 0);
  const PassiveSpring both = passiveSpring(axis, {0, 0, 0.5 * largest, 10, 0});
  EXPECT_TRUE(both.clamped);
  EXPECT_FLOAT_EQ(both.parameters.stiffness, 0.5F * largest);
  EXPECT_NEAR(both.parameters.damping, vibe_firmware::maxDamping(axis, 0.5F * largest), 1e-6);
  const PassiveSpring stiff = passiveSpring(axis, {0, 0, 2.0 * largest, 0, 0});
  EXPECT_TRUE(stiff.clamped);
  EXPECT_NEAR(stiff.parameters.stiffness, largest, 1e-3 * largest);
}

TEST(PassiveSpring, ATorqueBeyondTheMotorIsTheSameLineFromAnotherPoint) {
  const AxisConfig axis;
  const PassiveSpring result = passiveSpring(axis, {0.1, 0.1, 0.2, 0, 0});
  EXPECT_TRUE(result.clamped);
  EXPECT_LE(result.parameters.torque, axis.torque_limit);
  for (const double x : {-1.0, 0.1, 0.4, 0.5, 0.6, 0.7, 2.0}) {
    const double wanted = std::clamp<double>(0.1 - 0.2 * (x - 0.1), -axis.torque_limit, axis.torque_limit);
    EXPECT_NEAR(torqueAt(result.parameters, x), wanted, 1e-7) << x;
  }
}

TEST(PassiveSpring, WhateverComesIsAccepted) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> exponent(-12, 12), sign(-1, 1);
  const auto any = [&] { return std::pow(10, exponent(random)); };
  int clamped = 0;
  for (int i = 0; i < 100000; ++i) {
    AxisConfig axis;
    axis.velocity_pole = 0.98F * static_cast<float>(std::abs(sign(random)));
    axis.radians_per_count = static_cast<float>(1e-6 * std::pow(10, 4 * std::abs(sign(random))));
    const PassiveSpring result =
        passiveSpring(axis, {sign(random) * any(), sign(random) * any(), any(), any(), sign(random) * any()});
    ASSERT_EQ(vibe_firmware::validate(axis, result.parameters).refusal, Refusal::None) << i;
    clamped += result.clamped ? 1 : 0;
  }
  EXPECT_GT(clamped, 1000);
}

}  // namespace
}  // namespace vibe::hardware::passive_spring_test
