#include "vibe_core/trainee/trainee_script.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace vibe::timeline_test {
namespace {

TEST(Timeline, EmptyOneRests) {
  Timeline timeline;
  timeline.setStart(Rotation, 0.4);
  EXPECT_EQ(timeline.duration(), 0);
  EXPECT_EQ(timeline.position(Rotation, 5), 0.4);
  EXPECT_EQ(timeline.position(Insertion, 5), 0);
  EXPECT_FALSE(timeline.pressed(Cinch, 5));
  EXPECT_EQ(timeline.phase(5), "");
  EXPECT_EQ(timeline.jointFreeAt(Rotation), 0);
  EXPECT_EQ(timeline.lastEdge(Cinch), -std::numeric_limits<double>::infinity());
}

TEST(Timeline, EachMotionStartsWhereTheLastEnded) {
  Timeline timeline;
  timeline.setStart(Rotation, 1);
  timeline.addMotion(Rotation, 1, 2, 3);
  timeline.addMotion(Rotation, 4, 6, -1);
  EXPECT_EQ(timeline.position(Rotation, 0.5), 1);
  EXPECT_EQ(timeline.position(Rotation, 1.5), 2);
  EXPECT_EQ(timeline.position(Rotation, 3), 3);
  EXPECT_EQ(timeline.position(Rotation, 5), 1);
  EXPECT_EQ(timeline.position(Rotation, 7), -1);
  EXPECT_EQ(timeline.jointTarget(Rotation), -1);
  EXPECT_EQ(timeline.jointFreeAt(Rotation), 6);
  EXPECT_EQ(timeline.duration(), 6);
}

TEST(Timeline, EdgesAndPhasesHoldUntilTheNext) {
  Timeline timeline;
  timeline.addEdge(Needle, 1, true);
  timeline.addEdge(Needle, 2, false);
  timeline.addPhase(0.5, "a");
  timeline.addPhase(3, "b");
  EXPECT_FALSE(timeline.pressed(Needle, 0.99));
  EXPECT_TRUE(timeline.pressed(Needle, 1));
  EXPECT_FALSE(timeline.pressed(Needle, 2));
  EXPECT_FALSE(timeline.isPressed(Needle));
  EXPECT_EQ(timeline.phase(0.4), "");
  EXPECT_EQ(timeline.phase(2.9), "a");
  EXPECT_EQ(timeline.phase(3), "b");
  EXPECT_EQ(timeline.duration(), 3);
  timeline.extendTo(2);
  EXPECT_EQ(timeline.duration(), 3);
}

}  // namespace
}  // namespace vibe::timeline_test
