#include "vibe_firmware/core/haptic_device.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace vibe_firmware::haptic_device_test {
namespace {

ParameterReport springs(float stiffness, float damping, float position, float torque = 0) {
  ParameterReport report;
  report.number = 7;
  for (AxisParameters& axis : report.axes) {
    axis.stiffness = stiffness;
    axis.damping = damping;
    axis.position = position;
    axis.torque = torque;
    axis.torque_limit = 0.029F;
  }
  return report;
}

/// A device whose shafts are where the test puts them.
class HapticDevice : public ::testing::Test {
 protected:
  std::array<float, kAxisCount> tick(std::int32_t count) {
    sample_.counter.fill(static_cast<std::uint32_t>(count) & 0xFFFF);
    sample_.time_us += 1000;
    return step(config_, sample_, state_);
  }

  HapticConfig config_{};
  HapticState state_ = initialState(config_);
  HapticSample sample_{};
};

TEST_F(HapticDevice, IsSilentAndWithoutTorqueUntilTheFirstParameters) {
  for (int i = 0; i < 10; ++i) EXPECT_EQ(tick(5 * i)[0], 0);
  EXPECT_TRUE(state_.status.flags & kHostSilent);
}

TEST_F(HapticDevice, SpringFadesWhenTheHostIsSilentAndDampingStays) {
  tick(0);
  setParameters(config_, springs(0.2F, 1e-3F, 0.05F), state_);
  const float full = 0.2F * 0.05F;
  for (int i = 1; i <= 200; ++i) tick(0);
  EXPECT_NEAR(state_.axes[0].torque, full, 1e-7F);
  for (int i = 1; i <= 50; ++i) {
    const float expected = full * static_cast<float>(50 - i) / 50;
    ASSERT_NEAR(tick(0)[0], expected, 1e-7F) << "tick " << i << " of the ramp";
  }
  for (int i = 1; i < 200; ++i) tick(10 * i);
  EXPECT_NEAR(tick(2000)[0], -1e-3F * 3.07F, 1e-5F);
}

TEST_F(HapticDevice, RefusedSetChangesNothingButTheVerdict) {
  setParameters(config_, springs(0.2F, 1e-3F, 0), state_);
  ParameterReport bad = springs(0.1F, 1e-3F, 0);
  bad.number = 8;
  bad.axes[1].stiffness = 50;
  const AxisState before = state_.axes[0];
  const Verdict verdict = setParameters(config_, bad, state_);
  EXPECT_EQ(verdict.refusal, Refusal::ViscousFriction);
  EXPECT_EQ(verdict.axis, 1);
  EXPECT_EQ(state_.parameters.number, 7);
  EXPECT_EQ(state_.parameters.axes[0].stiffness, 0.2F);
  EXPECT_EQ(state_.axes[0].transition, before.transition);
  EXPECT_EQ(state_.status.refused_number, 8);
  EXPECT_EQ(state_.status.accepted, 1U);
  EXPECT_EQ(state_.status.refused, 1U);
  tick(0);
  EXPECT_TRUE(state_.status.flags & kRefused);
  setParameters(config_, springs(0.2F, 1e-3F, 0), state_);
  tick(0);
  EXPECT_FALSE(state_.status.flags & kRefused);
}

TEST_F(HapticDevice, EncoderFaultSwitchesBothMotorsOffAtOnce) {
  tick(0);
  setParameters(config_, springs(0.2F, 0, 0.05F), state_);
  for (int i = 0; i < 10; ++i) tick(0);
  ASSERT_GT(state_.axes[0].torque, 0);
  sample_.counter[1] = 20000;
  const std::array<float, kAxisCount> torque = step(config_, sample_, state_);
  EXPECT_EQ(torque[0], 0);
  EXPECT_EQ(torque[1], 0);
  EXPECT_TRUE(state_.status.flags & kEncoderFault);
  EXPECT_EQ(takeReport(config_, state_).torque[0], 0);
}

TEST_F(HapticDevice, FaultOfThePowerStageTakesTheTorqueUntilTheNextParameters) {
  config_.axes[0].slew_limit = 1;  // 1 mN m per tick
  tick(0);
  setParameters(config_, springs(0.2F, 0, 0.05F), state_);
  for (int i = 0; i < 50; ++i) tick(0);
  ASSERT_NEAR(state_.axes[0].torque, 0.01, 1e-6);
  sample_.drive_fault = true;
  EXPECT_EQ(step(config_, sample_, state_)[0], 0);
  EXPECT_TRUE(takeReport(config_, state_).flags & kDriveFault);
  EXPECT_EQ(takeReport(config_, state_).torque[0], 0) << "the report must not show a torque that does not act";
  setParameters(config_, springs(0.2F, 0, 0.05F), state_);
  EXPECT_EQ(step(config_, sample_, state_)[0], 0);
  sample_.drive_fault = false;
  EXPECT_EQ(step(config_, sample_, state_)[0], 0);
  EXPECT_FALSE(state_.status.flags & kDriveFault);
  EXPECT_FALSE(state_.status.flags & kEncoderFault);
  setParameters(config_, springs(0.2F, 0, 0.05F), state_);
  const float slew = config_.axes[0].slew_limit * config_.axes[0].sample_period;
  float last = 0;
  for (int i = 0; i < 50; ++i) {
    const float torque = step(config_, sample_, state_)[0];
    EXPECT_LE(torque - last, slew + 1e-7F);
    last = torque;
  }
  EXPECT_NEAR(last, 0.01, 1e-6);
}

TEST_F(HapticDevice, ReportShowsSampleAndState) {
  for (int i = 0; i <= 10; ++i) {
    sample_.buttons = 0x8001;
    tick(100 * i);
  }
  const InputReport report = takeReport(config_, state_);
  EXPECT_EQ(report.counts[0], 1000);
  EXPECT_EQ(report.axes[0], std::lround(1000 * 3.07e-4 / 6.2832 * 32767));
  EXPECT_EQ(report.buttons, 0x8001);
  EXPECT_EQ(report.time_us, 11000U);
  EXPECT_EQ(report.sequence, 0);
  EXPECT_EQ(takeReport(config_, state_).sequence, 1);
}

}  // namespace
}  // namespace vibe_firmware::haptic_device_test
