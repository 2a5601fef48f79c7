#include "conversions/input_message.hpp"
#include "vibe_core/constraints/pull_patch.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "sentences.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_testing/worlds.hpp"

namespace vibe::sim::pull_message_test {
namespace {

vibe_msgs::TissuePull goodPull() {
  vibe_msgs::TissuePull message;
  message.header.frame_id = "stomach";
  message.header.stamp.fromNSec(42);
  message.particle = 5;
  message.target.x = 0.1 / 3, message.target.y = -2, message.target.z = 3;
  return message;
}

std::string errorOf(const vibe_msgs::TissuePull& message) {
  return sentenceOf([&] { readPull(message); });
}

TEST(PullMessage, isReadBitForBitInBothFrames) {
  vibe_msgs::TissuePull message = goodPull();
  for (const char* frame : {"stomach", "world"}) {
    message.header.frame_id = frame;
    const InputSample sample = readPull(message);
    EXPECT_EQ(sample.channel, InputChannel::Pull);
    EXPECT_EQ(sample.stamp, 42);
    EXPECT_EQ(sample.pull_particle, 5);
    EXPECT_EQ(sample.pull_target, Eigen::Vector3d(0.1 / 3, -2, 3));
  }
}

TEST(PullMessage, whatIsWrongIsNamed) {
  vibe_msgs::TissuePull message = goodPull();
  EXPECT_EQ(errorOf(message), "");
  message.header.frame_id = "map";
  EXPECT_NE(errorOf(message).find("'map'"), std::string::npos);
  message = goodPull();
  message.target.z = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(errorOf(message).find("finite"), std::string::npos);
  message = goodPull();
  message.particle = -2;
  EXPECT_NE(errorOf(message).find("-2"), std::string::npos);
}

TEST(PullMessage, lettingGoNeedsNothingElse) {
  vibe_msgs::TissuePull message;
  message.particle = -1;
  message.target.x = std::numeric_limits<double>::infinity();
  const InputSample sample = readPull(message);
  EXPECT_EQ(sample.pull_particle, -1);
  EXPECT_TRUE(sample.pull_target.isZero());
}

TEST(PullMessage, theStateSaysPlaceTargetAndForce) {
  test::World world(test::bareScene(), test::plainOrgan(test::icosphere(0.05, 2), 2e-3));
  StepInput input;
  input.pull_particle = 5;
  input.pull_target = 1.1 * world.position(5);
  world.run(0.1, input);
  const vibe_msgs::TissuePullState held = makePullState(world.state, 7);
  EXPECT_EQ(held.header.frame_id, "world");
  EXPECT_EQ(held.header.stamp.toNSec(), 7u);
  EXPECT_EQ(held.particle, 5);
  EXPECT_EQ(held.position.x, heldPosition(world.state).x());
  EXPECT_EQ(held.target.y, world.state.pull.target.y());
  EXPECT_EQ(held.force.z, world.state.pull.force.z());
  EXPECT_GT(world.state.pull.force.norm(), 0.01);
  world.step();
  EXPECT_EQ(makePullState(world.state, 8).particle, -1);
}

}  // namespace
}  // namespace vibe::sim::pull_message_test
