#include "vibe_hardware/driver/scope_joints.hpp"

#include <gtest/gtest.h>

namespace vibe::hardware::scope_joints_test {
namespace {

constexpr std::uint16_t kHomingBit = 1 << 6;

class ScopeJointsTest : public testing::Test {
 protected:
  Calibration calibration = Calibration::load("../config/devices.yaml");
  ScopeJoints joints{calibration};

  static DeviceSample sample(double first, double second, std::uint16_t buttons = 0, bool restarted = false) {
    DeviceSample s;
    s.position = {first, second};
    s.buttons = buttons;
    s.restarted = restarted;
    return s;
  }
};

TEST_F(ScopeJointsTest, NothingIsKnownBeforeBothDevicesHaveSpoken) {
  EXPECT_FALSE(joints.isKnown());
  joints.take(DeviceKind::Haptic, sample(5, 1));
  EXPECT_FALSE(joints.isKnown());
  joints.take(DeviceKind::Input, sample(0.5, -0.5));
  EXPECT_TRUE(joints.isKnown());
  EXPECT_EQ(joints.positions(), (std::array<double, 4>{0.05, 1, 0.5, -0.5}));
  joints.lose(DeviceKind::Input);
  EXPECT_FALSE(joints.isKnown());
  EXPECT_EQ(joints.positions()[2], 0.5);
}

TEST_F(ScopeJointsTest, PositionsStayWithinTheLimits) {
  joints.take(DeviceKind::Haptic, sample(-3, 4));
  EXPECT_EQ(joints.positions()[Insertion], 0);
  EXPECT_NEAR(joints.positions()[Rotation], 3.14159, 1e-5);
}

TEST_F(ScopeJointsTest, EffortIsTheTorqueInUnitsOfTheJoint) {
  DeviceSample s = sample(1, 1);
  s.torque = {0.02, -0.01};
  joints.take(DeviceKind::Haptic, s);
  EXPECT_DOUBLE_EQ(joints.effort(Insertion), 2);  // N, roller of 1 cm
  EXPECT_DOUBLE_EQ(joints.effort(Rotation), -0.01);
}

TEST_F(ScopeJointsTest, HomingMakesThePositionsThoseOfTheCalibration) {
  joints.take(DeviceKind::Haptic, sample(7, 1));
  EXPECT_FALSE(joints.take(DeviceKind::Input, sample(0.5, 0.3)));
  EXPECT_FALSE(joints.isHomed());
  EXPECT_TRUE(joints.take(DeviceKind::Input, sample(0.5, 0.3, kHomingBit)));
  EXPECT_TRUE(joints.isHomed());
  EXPECT_EQ(joints.positions(), (std::array<double, 4>{0, 0, 0, 0}));
  EXPECT_FALSE(joints.take(DeviceKind::Input, sample(0.6, 0.3, kHomingBit))) << "once per press";
  EXPECT_NEAR(joints.positions()[TipUpDown], 0.1, 1e-12);
  joints.take(DeviceKind::Haptic, sample(9, 1));
  EXPECT_NEAR(joints.positions()[Insertion], 0.02, 1e-12);
  EXPECT_NEAR(jointPosition(joints.scale(Insertion), 9), 0.02, 1e-12);
}

TEST_F(ScopeJointsTest, OnlyDevicesThatAreThereAreHomed) {
  joints.take(DeviceKind::Input, sample(0.5, 0.3, kHomingBit));
  EXPECT_FALSE(joints.isHomed());
}

TEST_F(ScopeJointsTest, AfterARestartTheJointsContinueAndAreNotHomed) {
  joints.take(DeviceKind::Haptic, sample(0, 0));
  joints.take(DeviceKind::Input, sample(0, 0));
  joints.take(DeviceKind::Input, sample(0, 0, kHomingBit));
  joints.take(DeviceKind::Haptic, sample(8, 1));
  joints.lose(DeviceKind::Haptic);
  joints.take(DeviceKind::Haptic, sample(0, 0, 0, true));
  EXPECT_NEAR(joints.positions()[Insertion], 0.08, 1e-12);
  EXPECT_NEAR(joints.positions()[Rotation], 1, 1e-12);
  EXPECT_FALSE(joints.isHomed());
  joints.take(DeviceKind::Haptic, sample(1, 0));
  EXPECT_NEAR(joints.positions()[Insertion], 0.09, 1e-12);
}

TEST_F(ScopeJointsTest, AReplugWithoutARestartKeepsTheRealPosition) {
  joints.take(DeviceKind::Haptic, sample(8, 1));
  joints.lose(DeviceKind::Haptic);
  joints.take(DeviceKind::Haptic, sample(10, 1));
  EXPECT_NEAR(joints.positions()[Insertion], 0.1, 1e-12);
}

TEST_F(ScopeJointsTest, TheFirstSampleOfAllIsAbsolute) {
  joints.take(DeviceKind::Haptic, sample(8, 1, 0, true));
  EXPECT_NEAR(joints.positions()[Insertion], 0.08, 1e-12);
}

TEST(ScopeButtons, TellsOnlyChangesOfTheSixButtons) {
  ScopeButtons buttons(Calibration::load("../config/devices.yaml"));
  EXPECT_TRUE(buttons.take(DeviceKind::Input, 1));
  EXPECT_FALSE(buttons.take(DeviceKind::Input, 1 | kHomingBit));
  EXPECT_FALSE(buttons.take(DeviceKind::Haptic, 0xFFFF));
  EXPECT_EQ(buttons.pressed(), (std::array<std::uint8_t, 6>{1, 0, 0, 0, 0, 0}));
  EXPECT_TRUE(buttons.take(DeviceKind::Input, 0b110000));
  EXPECT_EQ(buttons.pressed(), (std::array<std::uint8_t, 6>{0, 0, 0, 0, 1, 1}));
  EXPECT_TRUE(buttons.take(DeviceKind::Input, 0));
}

TEST(SuturingDeviceDrive, MovesWhileAButtonIsHeldAndStopsAtTheLimits) {
  const Calibration calibration = Calibration::load("../config/devices.yaml");
  ScopeButtons buttons(calibration);
  SuturingDeviceDrive drive(*calibration.suturing_device);
  buttons.take(DeviceKind::Input, 1 << 8 | 1 << 11);  // helix forward, turning back
  for (int i = 0; i < 100; ++i) drive.advance(buttons, 0.01);
  EXPECT_NEAR(drive.positions()[0], 0.01, 1e-9);
  EXPECT_NEAR(drive.positions()[1], -4 * 3.14159265, 1e-6);
  EXPECT_EQ(drive.positions()[2], 0);
  buttons.take(DeviceKind::Input, 1 << 8 | 1 << 9);  // both: stands still
  drive.advance(buttons, 0.05);
  EXPECT_NEAR(drive.positions()[0], 0.01, 1e-9);
  buttons.take(DeviceKind::Input, 1 << 8);
  for (int i = 0; i < 1000; ++i) drive.advance(buttons, 0.01);
  EXPECT_EQ(drive.positions()[0], 0.03);
}

TEST(SuturingDeviceDrive, AGapIsNoMotionAndACameraSetsThePosition) {
  const Calibration calibration = Calibration::load("../config/devices.yaml");
  ScopeButtons buttons(calibration);
  SuturingDeviceDrive drive(*calibration.suturing_device);
  buttons.take(DeviceKind::Input, 1 << 8);
  drive.advance(buttons, 60);
  EXPECT_NEAR(drive.positions()[0], 1e-3, 1e-9);
  drive.setPositions({0.02, 1, 5});
  EXPECT_EQ(drive.positions()[1], 1);
  EXPECT_NEAR(drive.positions()[2], 0.018, 1e-9);
}

}  // namespace
}  // namespace vibe::hardware::scope_joints_test
