#include "vibe_firmware/core/input_device.hpp"

#include <gtest/gtest.h>

namespace vibe_firmware::input_device_test {
namespace {

TEST(InputDevice, ReportsCountsAxesButtonsAndTime) {
  InputConfig config;
  config.axes[1].radians_per_count = -3.07e-4F;
  InputState state;
  HapticSample sample;
  for (int i = 0; i <= 10; ++i) {
    sample.counter = {static_cast<std::uint32_t>(65500 + 10 * i) & 0xFFFF, static_cast<std::uint32_t>(300 * i)};
    sample.buttons = 0x0100;
    sample.time_us = 5000U * static_cast<std::uint32_t>(i);
    step(config, sample, state);
  }
  const InputReport report = takeReport(config, state);
  EXPECT_EQ(report.counts[0], 100);
  EXPECT_EQ(report.counts[1], 3000);
  EXPECT_EQ(report.axes[0], 160);    // 0.0307 rad of 6.2832
  EXPECT_EQ(report.axes[1], -4803);  // -0.921 rad
  EXPECT_EQ(report.buttons, 0x0100);
  EXPECT_EQ(report.time_us, 50000U);
  EXPECT_EQ(report.flags, 0);
  EXPECT_EQ(report.torque[0], 0);
  EXPECT_EQ(report.sequence, 0);
  EXPECT_EQ(takeReport(config, state).sequence, 1);
}

TEST(InputDevice, AxisBeyondFullScaleStaysAtItsEnd) {
  const InputConfig config;
  InputState state;
  HapticSample sample;
  for (std::uint32_t i = 0; i < 200; ++i) {
    sample.counter = {(300 * i) & 0xFFFF, (65536 - 300 * i) & 0xFFFF};
    step(config, sample, state);
  }
  const InputReport report = takeReport(config, state);
  EXPECT_EQ(report.axes[0], 32767);
  EXPECT_EQ(report.axes[1], -32767);
  EXPECT_EQ(report.counts[1], -199 * 300);
}

TEST(InputDevice, FlagsIndexAndFault) {
  const InputConfig config;
  InputState state;
  HapticSample sample;
  step(config, sample, state);
  sample.index[1] = true;
  step(config, sample, state);
  EXPECT_EQ(state.flags, kIndexed1);
  sample.counter[0] = 20000;
  step(config, sample, state);
  EXPECT_EQ(state.flags, kIndexed1 | kEncoderFault);
}

TEST(InputDevice, SequenceNumberWraps) {
  const InputConfig config;
  InputState state;
  state.sequence = 65535;
  EXPECT_EQ(takeReport(config, state).sequence, 65535);
  EXPECT_EQ(takeReport(config, state).sequence, 0);
}

}  // namespace
}  // namespace vibe_firmware::input_device_test
