#include "vibe_firmware/core/axis_control.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "vibe_firmware/core/passivity.hpp"

namespace vibe_firmware::axis_control_test {
namespace {

AxisParameters spring(float stiffness, float damping, float position = 0, float torque = 0) {
  AxisParameters parameters;
  parameters.stiffness = stiffness;
  parameters.damping = damping;
  parameters.position = position;
  parameters.torque = torque;
  parameters.torque_limit = 0.029F;
  return parameters;
}

/// One axis whose shaft is where the test puts it.
class Axis : public ::testing::Test {
 protected:
  float tick(std::int32_t count, float spring_gain = 1) {
    return step(config_, parameters_, spring_gain, 32, {static_cast<std::uint32_t>(count), false, 0}, state_);
  }

  void set(const AxisParameters& parameters) {
    takeOver(parameters_, parameters, state_);
    parameters_ = parameters;
  }

  /// Until nothing fades any more.
  void settle(std::int32_t count) {
    for (int i = 0; i < 300; ++i) tick(count);
  }

  AxisConfig config_{};
  AxisParameters parameters_{};
  AxisState state_ = initialAxisState(config_);
};

TEST(SpringDamper, IsTheLawOfItsParameters) {
  const AxisParameters p = spring(0.2F, 1e-3F, 0.05F, 0.004F);
  EXPECT_NEAR(springDamperTorque(p, 0.05F, 0), 0.004, 1e-9);
  EXPECT_NEAR(springDamperTorque(p, 0.07F, 2), 0.004 - 0.2 * 0.02 - 1e-3 * 2, 1e-8);
  EXPECT_EQ(springDamperTorque(p, 10, 0), -0.029F);
  EXPECT_EQ(springDamperTorque(p, -10, 0), 0.029F);
  EXPECT_NEAR(springDamperTorque(p, 10, -5), -0.029 + 0.005, 1e-8);  // the spring is limited before the damper
}

TEST_F(Axis, FollowsTheClosedFormUnderConstantSpeed) {
  set(spring(0.1F, 2e-3F, 0.02F, 0.001F));
  settle(0);
  const double speed = 5 * 3.07e-4 / 1e-3;  // 5 counts per tick
  for (int k = 1; k <= 60; ++k) {
    const double x = 5 * k * 3.07e-4, v = speed * (1 - std::pow(0.9, k));
    ASSERT_NEAR(tick(5 * k), 0.001 - 0.1 * (x - 0.02) - 2e-3 * v, 2e-8) << "tick " << k;
  }
}

TEST_F(Axis, TorqueNeverExceedsTheLimitOfTheParameters) {
  AxisParameters parameters = spring(0.4F, 2e-3F);
  parameters.torque_limit = 0.01F;
  set(parameters);
  settle(0);
  float largest = 0;
  for (int i = 0; i < 2000; ++i)
    largest = std::max(largest, std::fabs(tick(static_cast<std::int32_t>(600 * std::sin(0.02 * i)))));
  EXPECT_EQ(largest, 0.01F);
  tick(300);
  settle(200);
  EXPECT_TRUE(state_.limited);
  settle(10);
  EXPECT_FALSE(state_.limited);
}

TEST_F(Axis, LimitedTorqueSetsTheFilterBack) {
  AxisParameters parameters = spring(0, 5e-3F);
  parameters.torque_limit = 0.01F;
  set(parameters);
  settle(0);
  for (int i = 1; i <= 50; ++i) tick(100 * i);  // 30.7 rad/s would give 0.15 N m
  EXPECT_FLOAT_EQ(state_.torque, -0.01F);
  EXPECT_FLOAT_EQ(state_.velocity, 2);  // of which B makes the limit
  tick(100 * 50);                       // the hand stops: the torque falls at once
  EXPECT_FLOAT_EQ(state_.torque, -0.009F);
}

TEST_F(Axis, NewParametersComeInAtTheSlewLimit) {
  config_.slew_limit = 2;  // 0.002 N m per tick
  tick(0);
  set(spring(0.2F, 0, 0.05F));
  for (int i = 1; i <= 4; ++i) EXPECT_NEAR(tick(0), 0.002 * i, 1e-8);
  EXPECT_TRUE(state_.limited);
  EXPECT_NEAR(tick(0), 0.01, 1e-8);
  EXPECT_FALSE(state_.limited);
  set(spring(0.2F, 0, -0.05F));
  for (int i = 1; i <= 10; ++i) EXPECT_NEAR(tick(0), 0.01 - 0.002 * i, 1e-8);
  EXPECT_NEAR(tick(0), -0.01, 1e-8);
}

TEST_F(Axis, ResponseToTheHandIsNotDelayedBySlew) {
  config_.slew_limit = 0.5F;  // 0.0005 N m per tick
  set(spring(0.3F, 0));
  settle(0);
  EXPECT_NEAR(tick(200), -0.3 * 200 * 3.07e-4, 1e-7);  // 0.018 N m at once
}

TEST_F(Axis, LowerTorqueLimitIsReachedAtTheSlewLimit) {
  config_.slew_limit = 2;
  set(spring(0, 0, 0, 0.02F));
  settle(0);
  AxisParameters weaker = spring(0, 0, 0, 0.02F);
  weaker.torque_limit = 0;
  set(weaker);
  float before = 0.02F;
  for (int i = 0; i < 10; ++i) {
    const float now = tick(0);
    EXPECT_LE(std::fabs(now - before), 0.002F * 1.001F);
    before = now;
  }
  EXPECT_EQ(tick(0), 0);
}

TEST_F(Axis, NoTorqueJumpsWhateverIsSet) {
  config_.slew_limit = 2;
  tick(0);
  float before = 0;
  for (int i = 0; i < 3000; ++i) {
    if (i % 7 == 0) {
      const auto wave = [&](double w) { return static_cast<float>(std::sin(w * i)); };
      AxisParameters next = spring(0.4F * std::fabs(wave(0.37)), 0, 0.2F * wave(0.71), 0.029F * wave(0.23));
      next.torque_limit = 0.029F * std::fabs(wave(0.53));
      set(next);
    }
    const float now = tick(0);
    ASSERT_LE(std::fabs(now - before), 0.002F * 1.001F) << "tick " << i;
    before = now;
  }
}

TEST_F(Axis, SpringReturnsAfterSilenceWithoutAJump) {
  set(spring(0.2F, 0, 0.1F));
  settle(0);
  EXPECT_NEAR(tick(0, 0.5F), 0.01, 1e-8);
  EXPECT_NEAR(tick(0, 0), 0, 1e-8);
  config_.slew_limit = 2;
  set(spring(0.2F, 0, 0.1F));  // the watchdog starts again with gain 1
  for (int i = 1; i <= 9; ++i) EXPECT_NEAR(tick(0), 0.002 * i, 1e-7);
}

TEST_F(Axis, SeveralSetsBetweenTwoTicksDoNotJumpEither) {
  set(spring(0.2F, 0, 0.1F));
  settle(0);
  tick(0, 0);  // the host has been silent
  config_.slew_limit = 2;
  set(spring(0.2F, 0, 0.1F));
  set(spring(0.2F, 0, -0.1F));
  for (int i = 1; i <= 9; ++i) EXPECT_NEAR(tick(0), -0.002 * i, 1e-7);
}

TEST_F(Axis, AccountLastsAtTheSpeedLimit) {
  config_.speed_limit = 99.776F;  // 325.0003 counts per tick
  set(spring(0, 5e-3F));
  settle(0);
  state_.energy = {1e-3F, 0};
  state_.velocity = -50;
  EXPECT_GT(tick(0), 0.009F) << "all that the account can pay for one tick";
  tick(325);  // the hand takes it, and the torque changes its sign
  EXPECT_LT(state_.energy.balance, 1e-4F);
  EXPECT_GT(state_.energy.balance, 0);
  EXPECT_FALSE(state_.encoder.fault);
}

TEST_F(Axis, IndexCorrectionIsNoMotionOfTheHand) {
  config_.counts_per_turn = 100;
  set(spring(0.2F, 2e-3F));
  settle(0);
  step(config_, parameters_, 1, 32, {1, true, 0}, state_);
  settle(1);
  const float energy = state_.energy.balance;
  const float velocity = state_.velocity;
  step(config_, parameters_, 1, 32, {1, true, 6}, state_);  // the pulse says: 6 counts too many
  EXPECT_EQ(state_.encoder.count, -5);
  EXPECT_NEAR(state_.velocity, 0.9F * velocity, 1e-9);
  const float step_size = config_.radians_per_count;
  EXPECT_NEAR(state_.energy.balance, energy - 0.5F * step_size * 0.2F * 6 * step_size, 1e-8)
      << "only the torque change";
}

TEST_F(Axis, IndexCorrectionChangesTheTorqueAtTheSlewLimit) {
  config_.counts_per_turn = 1000;
  config_.slew_limit = 1;  // 1 mN m per tick
  set(spring(0.5F, 0));
  settle(0);
  step(config_, parameters_, 1, 32, {1, true, 0}, state_);
  settle(1);
  const float before = state_.torque;
  const float energy = state_.energy.balance;
  const float change = 0.5F * 60 * config_.radians_per_count;  // 60 counts too many: 9.2 mN m
  EXPECT_NEAR(step(config_, parameters_, 1, 32, {1, true, 60}, state_), before + 1e-3F, 1e-7);
  EXPECT_EQ(state_.encoder.count, -59);
  EXPECT_NEAR(tick(1), before + 2e-3F, 1e-7);
  settle(1);
  EXPECT_NEAR(state_.torque, before + change, 1e-7);
  EXPECT_LT(state_.energy.balance, energy) << "a change that the hand has not caused costs energy";
}

TEST_F(Axis, EmptyAccountDampsAndFillsAgain) {
  set(spring(0.2F, 0, 0.1F));
  settle(0);
  state_.energy = {0.1F * config_.energy_capacity, 0};  // what is reserved for damping
  EXPECT_EQ(tick(0), 0);
  EXPECT_TRUE(state_.passivity_acts);
  float torque = 0;
  for (int i = 1; i <= 100; ++i) torque = tick(20 * i);
  EXPECT_LT(torque, -0.01F) << "damping replaces the spring";
  for (int i = 101; i <= 3000 && state_.passivity_acts; ++i) tick(20 * i);
  EXPECT_FALSE(state_.passivity_acts) << "the hand has filled the account";
}

TEST_F(Axis, AccountRecoversFromNearlyNothing) {
  set(spring(0.2F, 0, 0.1F));
  settle(0);
  state_.energy = {1e-12F, 0};
  state_.torque = 0;
  for (int i = 1; i <= 2000; ++i) tick(static_cast<std::int32_t>(400 * std::sin(0.05 * i)));
  EXPECT_GE(state_.energy.balance, 0.1F * config_.energy_capacity) << "the reserve for damping is full again";
}

TEST_F(Axis, ObserverBooksTheExactWorkOfTheHeldTorque) {
  config_.energy_capacity = 10;
  set(spring(0.1F, 1e-3F));
  settle(0);
  state_.energy = {5, 0};
  double work = 0;
  for (int i = 1; i <= 2000; ++i) {
    const float held = state_.torque;
    const std::int32_t before = state_.encoder.count;
    tick(static_cast<std::int32_t>(std::lround(300 * std::sin(0.01 * i))));
    work += static_cast<double>(held) * (state_.encoder.count - before) * 3.07e-4;
  }
  EXPECT_LT(work, -1e-4);
  EXPECT_NEAR(state_.energy.balance, 5 - work, 1e-6);
}

}  // namespace
}  // namespace vibe_firmware::axis_control_test
