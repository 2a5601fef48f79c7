// Whether the scope has room, and how it comes another way where it has none.
#include <gtest/gtest.h>

#include "onlooker.hpp"
#include "trainee/bite_plan.hpp"
#include "trainee/picture.hpp"

namespace vibe::room_test {
namespace {

Eigen::Isometry3d tipAt(const TraineeHand::Joints& joints) {
  std::vector<Eigen::Isometry3d> poses;
  smallStomach()->tool->forwardKinematics(joints, poses);
  return smallStomach()->tool_base * poses[smallStomach()->tip_link];
}

/// Wall of the body that is farthest from a place, as a fold that has come there: `count` particles.
std::vector<int> putFold(const Eigen::Vector3d& place, int count, Observation& seen) {
  std::vector<int> fold;
  for (int i = 0; i < smallStomach()->particle_count && static_cast<int>(fold.size()) < count; ++i)
    if (smallStomach()->organ.region[i] == Region::Body && (seen.wall[i] - place).norm() > 60e-3) fold.push_back(i);
  for (const int i : fold) seen.wall[i] = place;
  return fold;
}

TraineeHand::Joints lookingAt(Onlooker& at, const WallPoint& place) {
  return bestView(at.me.position(place), at.me.outward(place), 20e-3, at.me);
}

TEST(Room, IsThereInAnOpenOrganAndNotInAFold) {
  Onlooker at;
  const TraineeHand::Joints joints = lookingAt(at, at.me.seen_map->at(0.5, 0.3));
  EXPECT_EQ(overlapWithWall(*smallStomach(), at.seen.wall, joints), 0);
  const std::vector<int> fold = putFold(tipAt(joints) * Eigen::Vector3d(-10e-3, 0, 0), 5, at.seen);
  const double overlap = overlapWithWall(*smallStomach(), at.seen.wall, joints);
  double area = 0;
  for (const int i : fold) area += smallStomach()->area[i];
  EXPECT_GT(overlap, area * 3e-3) << "on the axis, some 6 mm deep";
  EXPECT_LT(overlap, area * 10e-3);
}

TEST(Room, WhatTheTipIsToTouchDoesNotCount) {
  Onlooker at;
  const TraineeHand::Joints joints = lookingAt(at, at.me.seen_map->at(0.5, 0.3));
  const std::vector<int> fold = putFold(tipAt(joints) * Eigen::Vector3d(-1.5e-3, 0, 0), 5, at.seen);
  const auto isFold = [&](int i) { return std::find(fold.begin(), fold.end(), i) != fold.end(); };
  ASSERT_GT(overlapWithWall(*smallStomach(), at.seen.wall, joints), 0);
  EXPECT_EQ(overlapWithWall(*smallStomach(), at.seen.wall, joints, isFold), 0);
}

TEST(BestView, ComesRoundAFoldThatStandsInTheWay) {
  Onlooker at;
  const WallPoint place = at.me.seen_map->at(0.5, 0.3);
  const TraineeHand::Joints free = lookingAt(at, place);
  putFold(tipAt(free) * Eigen::Vector3d(-10e-3, 0, 0), 20, at.seen);
  const double before = overlapWithWall(*smallStomach(), at.seen.wall, free);
  const TraineeHand::Joints round = lookingAt(at, place);
  EXPECT_LT(overlapWithWall(*smallStomach(), at.seen.wall, round), 0.5 * before);
}

TEST(PlanBite, ComesRoundAFoldThatStandsInTheWay) {
  Onlooker at;
  const WallPoint target = at.me.seen_map->at(0.5, 0.3);
  const BitePlan free = planBite(target, at.me);
  EXPECT_LT(free.in_the_way, kRoomy);
  putFold(tipAt(free.joints) * Eigen::Vector3d(-30e-3, 0, 0), 20, at.seen);
  const double before = overlapWithWall(*smallStomach(), at.seen.wall, free.joints);
  const BitePlan round = planBite(target, at.me);
  ASSERT_TRUE(std::isfinite(round.cost));
  EXPECT_LT(round.in_the_way, 0.5 * before);
}

}  // namespace
}  // namespace vibe::room_test
