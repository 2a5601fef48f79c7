// How the hand moves the joints: it yields to what it feels.
#include "tool/hand_model.hpp"

#include <gtest/gtest.h>

namespace vibe::hand_model_test {
namespace {

using Joints = std::array<double, kJointCount>;

const Joints kStart{0.1, 0, 0.2, 0, 0.01, 0, 0};
const Joints kEnd{0.102, -0.05, 0.25, 0, 0.012, 0.4, 0};
const std::array<double, kScopeJointCount> kEffort{1.0, 0.1, -0.1, 0.1};

TEST(HandModel, IsFreeBelowTheForceAtWhichTheHandSlowsDown) {
  EXPECT_EQ(HandModel::slowedByForce(kStart, kEnd, kEffort, 9.9), kEnd);
}

TEST(HandModel, StopsOnlyWhatPushesOn) {
  const Joints felt = HandModel::slowedByForce(kStart, kEnd, kEffort, 25);
  EXPECT_EQ(felt[Insertion], kStart[Insertion]) << "pushes against its effort";
  EXPECT_EQ(felt[Rotation], kEnd[Rotation]) << "yields to it";
  EXPECT_EQ(felt[TipUpDown], kEnd[TipUpDown]) << "yields to it";
  for (int j = kScopeJointCount; j < kJointCount; ++j) EXPECT_EQ(felt[j], kEnd[j]) << "an instrument";
}

TEST(HandModel, SlowsDownEvenlyInBetween) {
  double before = kEnd[Insertion] - kStart[Insertion];
  for (double force = 10.5; force < 20; force += 0.5) {
    const double way = HandModel::slowedByForce(kStart, kEnd, kEffort, force)[Insertion] - kStart[Insertion];
    EXPECT_LT(way, before) << force;
    EXPECT_GT(way, 0) << force;
    before = way;
  }
}

TEST(HandModel, DoesNotPushOnAJointThatTissueHasStopped) {
  std::array<int, kJointCount> stall{};
  HandModel::countStall({1, 0, 0, 0, 0, -1, 0}, stall);
  const Joints held = HandModel::heldBack(kStart, kEnd, stall);
  EXPECT_EQ(held[Insertion], kStart[Insertion]);
  EXPECT_EQ(held[5], kEnd[5]) << "it was stopped on the way back, and goes on";
  for (int step = 0; step < 6; ++step) HandModel::countStall({}, stall);
  EXPECT_EQ(HandModel::heldBack(kStart, kEnd, stall), kEnd) << "for some steps only";
}

}  // namespace
}  // namespace vibe::hand_model_test
