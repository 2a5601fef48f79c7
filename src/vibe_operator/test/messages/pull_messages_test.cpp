#include "vibe_operator/messages/command_messages.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace vibe::operating::pull_messages_test {
namespace {

vibe_msgs::TissuePullState goodState() {
  vibe_msgs::TissuePullState message;
  message.particle = 7;
  message.position.x = 0.1, message.target.y = 0.2, message.force.z = -3;
  return message;
}

TEST(PullMessages, ValidStateIsRead) {
  PullState state;
  EXPECT_EQ(readPullState(goodState(), state), "");
  EXPECT_EQ(state.particle, 7);
  EXPECT_EQ(state.position, Eigen::Vector3d(0.1, 0, 0));
  EXPECT_EQ(state.target, Eigen::Vector3d(0, 0.2, 0));
  EXPECT_EQ(state.force, Eigen::Vector3d(0, 0, -3));
}

TEST(PullMessages, InvalidValuesAreReportedAndChangeNothing) {
  PullState state;
  readPullState(goodState(), state);
  for (double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e7}) {
    for (int field = 0; field < 3; ++field) {
      vibe_msgs::TissuePullState message = goodState();
      message.particle = 8;
      (field == 0 ? message.position.y : field == 1 ? message.target.z : message.force.x) = bad;
      EXPECT_NE(readPullState(message, state), "") << field;
      EXPECT_EQ(state.particle, 7);
    }
  }
  vibe_msgs::TissuePullState message = goodState();
  message.particle = -2;
  EXPECT_NE(readPullState(message, state), "");
}

TEST(PullMessages, ReleasedSpringIsAValidState) {
  PullState state;
  EXPECT_EQ(readPullState(vibe_msgs::TissuePullState(), state), "");
  vibe_msgs::TissuePullState message;
  message.particle = -1;
  EXPECT_EQ(readPullState(message, state), "");
  EXPECT_EQ(state.particle, -1);
}

}  // namespace
}  // namespace vibe::operating::pull_messages_test
