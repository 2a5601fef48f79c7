#include "vibe_operator/messages/command_messages.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <sstream>

namespace vibe::operating::drive_messages_test {
namespace {

std::string shippedUrdf() {
  const std::ifstream file("../../vibe_description/urdf/scope.urdf");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(DriveMessages, LimitsAreThoseOfTheUrdf) {
  JointLimits limits;
  EXPECT_EQ(readJointLimits(shippedUrdf(), limits), "");
  EXPECT_EQ(limits[Insertion].upper, 0.3);
  EXPECT_EQ(limits[Insertion].velocity, 0.15);
  EXPECT_NEAR(limits[TipUpDown].lower, -1.5708, 1e-4);
  EXPECT_EQ(limits[NeedleDriver].upper, 0.018);
}

TEST(DriveMessages, UnusableUrdfIsReported) {
  JointLimits limits;
  EXPECT_TRUE(contains(readJointLimits("", limits), "no URDF"));
  EXPECT_TRUE(contains(readJointLimits("<robot", limits), "no URDF"));
  std::string other = shippedUrdf();
  other.replace(other.find("name=\"tip_up_down\""), 18, "name=\"tip_up\"");
  EXPECT_TRUE(contains(readJointLimits(other, limits), "'tip_up_down'")) << readJointLimits(other, limits);
  other = shippedUrdf();
  other.replace(other.find("velocity=\"0.15\""), 15, "velocity=\"0\"");
  EXPECT_TRUE(contains(readJointLimits(other, limits), "'insertion'")) << readJointLimits(other, limits);
}

TEST(DriveMessages, JointsAreMatchedByName) {
  sensor_msgs::JointState message;
  for (std::size_t i = kJointCount; i-- > 0;) {
    message.name.push_back(driveJointNames()[i]);
    message.position.push_back(static_cast<double>(i));
  }
  Joints joints{};
  ASSERT_TRUE(readJoints(message, joints));
  EXPECT_EQ(joints, (Joints{0, 1, 2, 3, 4, 5, 6}));
  message.position[2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(readJoints(message, joints));
  message.position.resize(3);
  EXPECT_FALSE(readJoints(message, joints));
  message.name.clear();
  EXPECT_FALSE(readJoints(message, joints));
}

TEST(DriveMessages, MessagesHoldTheJointsOfTheirTopics) {
  const Joints joints = {0, 1, 2, 3, 4, 5, 6};
  const auto scope = scopeMessage(joints, ros::Time(5)), device = suturingDeviceMessage(joints, ros::Time(5));
  EXPECT_EQ(scope.name, (std::vector<std::string>{"insertion", "rotation", "tip_up_down", "tip_left_right"}));
  EXPECT_EQ(scope.position, (std::vector<double>{0, 1, 2, 3}));
  EXPECT_EQ(device.name, (std::vector<std::string>{"helix_advance", "helix_rotation", "needle_driver"}));
  EXPECT_EQ(device.position, (std::vector<double>{4, 5, 6}));
  EXPECT_EQ(device.header.stamp, ros::Time(5));
}

vibe_msgs::ProcedureState stateAt(double stamp, double time, std::uint64_t step) {
  vibe_msgs::ProcedureState state;
  state.header.stamp = ros::Time(stamp);
  state.time = time;
  state.step = step;
  state.scene = "stomach";
  return state;
}

TEST(DriveMessages, OtherSessionIsRecognised) {
  const auto before = stateAt(100, 50, 3000);
  EXPECT_FALSE(isOtherSession(before, before));
  EXPECT_FALSE(isOtherSession(before, stateAt(101, 51, 3060)));
  EXPECT_FALSE(isOtherSession(before, stateAt(110, 51, 3060))) << "a slow simulator drops wall time";
  EXPECT_TRUE(isOtherSession(before, stateAt(101, 0, 0))) << "a reset";
  EXPECT_TRUE(isOtherSession(before, stateAt(101, 80, 4800))) << "a later snapshot";
  auto other = stateAt(101, 51, 3060);
  other.scene = "sphere";
  EXPECT_TRUE(isOtherSession(before, other));
}

TEST(DriveMessages, SituationFollowsFromTheState) {
  vibe_msgs::ProcedureState state;
  state.tool_state = "grip";
  state.held_particles = 9;
  state.needle_loaded = true;
  state.bites = 4;
  state.sutures_open = 1;
  DriveSituation now = situationOf(state);
  EXPECT_TRUE(now.holds && now.touches);
  EXPECT_EQ(now.set_bites, 4u);
  EXPECT_EQ(now.sets_tagged, 0u);
  state.needle_loaded = false;
  EXPECT_EQ(situationOf(state).sets_tagged, 1u);
  state.sutures_open = 0;
  state.sutures_cinched = 1;
  EXPECT_EQ(situationOf(state).sets_done, 1u);
}

}  // namespace
}  // namespace vibe::operating::drive_messages_test
