#include "vibe_firmware/hal/motor_drive.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace vibe_firmware::motor_drive_test {
namespace {

constexpr std::uint32_t kPeriod = 4320;

// Torque of a stalled motor at this duty: n k U d / R.
float stallTorque(const MotorDrive& drive, float duty) {
  return drive.transmission * drive.torque_constant * drive.supply_voltage * duty / drive.resistance;
}

TEST(MotorDrive, DutyGivesTheTorqueOfAStalledMotor) {
  const MotorDrive drive;
  for (const float torque : {-0.029F, -1e-4F, 0.0F, 0.0123F, 0.029F})
    EXPECT_NEAR(stallTorque(drive, dutyOf(drive, torque)), torque, 1e-8F);
}

TEST(MotorDrive, RatedTorqueNeedsThisDuty) {
  // 2.9 mN m / 11.5 mN m/A = 252 mA; * 19.8 ohm = 4.99 V of 9 V
  EXPECT_NEAR(dutyOf(MotorDrive{}, 0.029F), 0.5548F, 1e-4F);
}

TEST(MotorDrive, DutyIsLimitedToWhatTheSupplyGives) {
  EXPECT_EQ(dutyOf(MotorDrive{}, 1), 1);
  EXPECT_EQ(dutyOf(MotorDrive{}, -1), -1);
  EXPECT_EQ(dutyOf(MotorDrive{}, std::numeric_limits<float>::infinity()), 1);
  EXPECT_EQ(dutyOf(MotorDrive{}, std::numeric_limits<float>::quiet_NaN()), 0);
}

TEST(MotorDrive, DirectionTurnsTheMotor) {
  MotorDrive reversed;
  reversed.direction = -1;
  EXPECT_EQ(dutyOf(reversed, 0.01F), -dutyOf(MotorDrive{}, 0.01F));
}

TEST(SlowDecay, BrakesAtZero) {
  const BridgeInputs inputs = slowDecay(0, kPeriod);
  EXPECT_EQ(inputs.first, kPeriod);
  EXPECT_EQ(inputs.second, kPeriod);
}

TEST(SlowDecay, DrivesForTheShareOfTheDutyAndBrakesForTheRest) {
  const BridgeInputs forward = slowDecay(0.25F, kPeriod);
  EXPECT_EQ(forward.first, kPeriod);
  EXPECT_EQ(forward.second, kPeriod * 3 / 4);
  const BridgeInputs reverse = slowDecay(-0.25F, kPeriod);
  EXPECT_EQ(reverse.first, kPeriod * 3 / 4);
  EXPECT_EQ(reverse.second, kPeriod);
}

TEST(SlowDecay, NeverCoasts) {
  for (float duty = -1; duty <= 1; duty += 0.001F) {
    const BridgeInputs inputs = slowDecay(duty, kPeriod);
    EXPECT_EQ(std::max(inputs.first, inputs.second), kPeriod) << duty;
    const float mean = (static_cast<float>(inputs.first) - static_cast<float>(inputs.second)) / kPeriod;
    EXPECT_NEAR(mean, duty, 0.51F / kPeriod);
  }
}

TEST(SlowDecay, FullDutyDrivesTheWholePeriod) {
  EXPECT_EQ(slowDecay(1, kPeriod).second, 0U);
  EXPECT_EQ(slowDecay(-1, kPeriod).first, 0U);
}

}  // namespace
}  // namespace vibe_firmware::motor_drive_test
