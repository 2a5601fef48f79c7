#include "hardware_messages.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "vibe_core/clocks/step_timer.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::hardware::hardware_messages_test {
namespace {

class HardwareMessagesTest : public testing::Test {
 protected:
  ScopeJoints joints{Calibration::load("../config/devices.yaml")};

  static vibe_msgs::HapticParameters message() {
    vibe_msgs::HapticParameters m;
    m.touching = true;
    m.joint_name = {"tip_left_right", "rotation", "insertion", "tip_up_down"};  // in any order
    m.joint_stiffness = {9, 0.5, 100, 9};
    m.joint_damping = {9, 0.01, 2, 9};
    m.joint_position = {9, 0.3, 0.05, 9};
    m.joint_velocity = {9, 0.1, 0.02, 9};
    m.joint_effort = {9, -0.02, 1, 9};
    return m;
  }

  std::string errorOf(const vibe_msgs::HapticParameters& m) {
    try {
      readHapticParameters(m, joints);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }
};

TEST_F(HardwareMessagesTest, JointsAreFoundByNameAndConvertedToTheAxes) {
  const HapticDriver::Targets targets = readHapticParameters(message(), joints);
  EXPECT_DOUBLE_EQ(targets[0].stiffness, 100 * 1e-4);  // roller of 1 cm
  EXPECT_DOUBLE_EQ(targets[0].damping, 2e-4);
  EXPECT_DOUBLE_EQ(targets[0].position, 5);
  EXPECT_DOUBLE_EQ(targets[0].velocity, 2);
  EXPECT_DOUBLE_EQ(targets[0].effort, 0.01);
  EXPECT_DOUBLE_EQ(targets[1].stiffness, 0.5);
  EXPECT_DOUBLE_EQ(targets[1].effort, -0.02);
}

TEST_F(HardwareMessagesTest, EveryMistakeHasItsSentence) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  auto m = message();
  m.joint_effort[2] = nan;
  EXPECT_EQ(errorOf(m), "joint_effort of insertion is not finite; send finite numbers.");
  m = message();
  m.joint_position[1] = -std::numeric_limits<double>::infinity();
  EXPECT_EQ(errorOf(m), "joint_position of rotation is not finite; send finite numbers.");
  m = message();
  m.joint_damping[1] = -1;
  EXPECT_EQ(errorOf(m), "stiffness or damping of rotation is negative; send values of at least 0.");
  m = message();
  m.joint_name[2] = "insert";
  EXPECT_EQ(errorOf(m), "joint 'insertion' is missing; send all joints.");
  m.joint_name[2] = "rotation";
  EXPECT_NE(errorOf(m), "no error");
  m = message();
  m.joint_name.insert(m.joint_name.begin(), 3, "other");
  EXPECT_NE(errorOf(m).find("has no values; send four joints."), std::string::npos);
  m = message();
  m.joint_stiffness[0] = nan;  // of a joint that the haptic device does not have
  EXPECT_EQ(errorOf(m), "no error");
}

TEST_F(HardwareMessagesTest, StampsOnlyIncrease) {
  ros::Time::init();
  StampSource source;
  const double now = steadyTime();
  const ros::Time first = source.at(now);
  EXPECT_NEAR((ros::Time::now() - first).toSec(), steadyTime() - now, 1e-3);
  ros::Time last = first;
  for (const double time : {now, now - 0.005, now + 1e-9, now + 0.01, now + 0.01}) {
    const ros::Time stamp = source.at(time);
    EXPECT_GT(stamp, last);
    last = stamp;
  }
}

TEST_F(HardwareMessagesTest, StatesAreThoseOfCrtk) {
  DeviceStatistics device;
  HapticStatistics haptic;
  EXPECT_EQ(operatingState(device, haptic), "DISABLED");
  device.state = LinkState::Running;
  EXPECT_EQ(operatingState(device, haptic), "PAUSED");
  haptic.in_force = true;
  EXPECT_EQ(operatingState(device, haptic), "ENABLED");
  device.flags = vibe_firmware::kEncoderFault;
  EXPECT_EQ(operatingState(device, haptic), "FAULT");
  device.flags = vibe_firmware::kDriveFault;
  EXPECT_EQ(operatingState(device, haptic), "FAULT");
  device.flags = 0;
  EXPECT_EQ(operatingState(device, haptic), "ENABLED");
  device.state = LinkState::Silent;
  EXPECT_EQ(operatingState(device, haptic), "FAULT");
}

}  // namespace
}  // namespace vibe::hardware::hardware_messages_test
