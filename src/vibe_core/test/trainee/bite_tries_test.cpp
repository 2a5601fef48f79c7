// What a trainee does otherwise after a try that failed, and beside the threads of earlier sets.
#include <gtest/gtest.h>

#include "onlooker.hpp"
#include "trainee/bite_attempt.hpp"
#include "trainee/bite_plan.hpp"

namespace vibe::bite_tries_test {
namespace {

TEST(BiteTries, WhatFailedIsNotTriedTheSameWayAgain) {
  Onlooker at;
  const WallPoint target = at.me.seen_map->at(0.5, 0.3);
  const BitePlan first = planBite(target, at.me);
  EXPECT_LT(planBite(target, at.me).turn.angularDistance(first.turn), 1e-9) << "without a failure";
  at.me.tries.failed.push_back({first.turn, 15e-3});
  EXPECT_GT(planBite(target, at.me).turn.angularDistance(first.turn), 0.3);
}

TEST(BiteTries, AfterASlipThePlanDrawsLess) {
  Onlooker at;
  const WallPoint target = at.me.seen_map->at(0.5, 0.3);
  const BitePlan first = planBite(target, at.me);
  at.me.tries.least_drawn = first.drawn + 1e-3;
  EXPECT_GT(planBite(target, at.me).drawn, first.drawn);
}

// The helix has hold from when it is pressed until it has drawn the wall by a millimetre.
TEST(BiteTries, ASlipIsRememberedWhereItWas) {
  Onlooker* self = nullptr;
  Onlooker at(Skill::expert(), [&](Observation& seen) {
    if (self == nullptr) return;
    seen.joints = self->hand.joints();
    seen.grips = self->hand.command().buttons[HelixGrab] && seen.joints[HelixAdvance] > 25e-3;
  });
  self = &at;
  const GoalResult result = BiteAttempt(at.me.seen_map->at(0.5, 0.3), 0, at.me).make();
  EXPECT_EQ(result.reason, "the helix slipped");
  EXPECT_NEAR(at.me.tries.least_drawn, 25e-3 + 3e-3, 1.5e-3);
  ASSERT_EQ(at.me.tries.failed.size(), 1U) << "nothing was learned from it, so the next try is another";
}

TEST(BiteTries, WhereTheHelixGotNoHoldTheDeviceComesAnotherWay) {
  Onlooker at;  // nothing is simulated: there is nothing to hold
  const WallPoint target = at.me.seen_map->at(0.5, 0.3);
  EXPECT_EQ(BiteAttempt(target, 0, at.me).make().reason, "the helix got no hold of the wall");
  ASSERT_EQ(at.me.tries.failed.size(), 1U);
  const Eigen::Quaterniond failed = at.me.tries.failed[0].turn;
  EXPECT_GT(planBite(target, at.me).turn.angularDistance(failed), 0.3);
}

TEST(BiteTries, TheHelixHoldsBesideTheThreadsOfEarlierSets) {
  Onlooker at;
  const WallPoint target = at.me.seen_map->at(0.5, 0.3);
  const auto toStitch = [&](const BitePlan& plan, const WallPoint& stitch) {
    return (at.me.position(plan.held) - at.me.position(stitch)).norm();
  };
  const BitePlan free = planBite(target, at.me);
  const WallPoint stitch = at.me.seen_map->walk(free.held, 1e-3, 0);
  at.me.stitches = {stitch};
  EXPECT_GT(toStitch(planBite(target, at.me), stitch), toStitch(free, stitch) + 2e-3);
}

double moved(const WallPoint& from, const WallPoint& to, const Onlooker& at) {
  return at.me.seen_map->alongWall(from, at.me.position(to) - at.me.position(from))[0];
}

/// How far all points of a set move beside a bite of an earlier set [m].
double movedBeside(const WallPoint& stitch, const SutureSetGoal& goal, Onlooker& at) {
  at.me.stitches.clear();
  const std::vector<WallPoint> free = targetsOf(goal, at.me);
  at.me.stitches = {stitch};
  const std::vector<WallPoint> targets = targetsOf(goal, at.me);
  const double first = moved(free[0], targets[0], at);
  for (std::size_t k = 1; k < targets.size(); ++k)
    EXPECT_NEAR(moved(free[k], targets[k], at), first, 1.5e-3) << "the shape remains";
  return first;
}

TEST(BesideThreads, TheWholePatternMovesAlongTheOrganAwayFromAnEarlierBite) {
  Onlooker at;
  SutureSetGoal goal;
  goal.centre = {0.5, 0.3};
  const std::vector<WallPoint> free = targetsOf(goal, at.me);
  const auto beside = [&](const WallPoint& target, double distal) { return at.me.seen_map->walk(target, distal, 0); };
  EXPECT_NEAR(movedBeside(beside(free[1], 3e-3), goal, at), 3e-3 - kBesideThread, 1.5e-3);
  EXPECT_NEAR(movedBeside(beside(free.back(), -3e-3), goal, at), kBesideThread - 3e-3, 1.5e-3);
  EXPECT_EQ(movedBeside(beside(free[1], 12e-3), goal, at), 0) << "far enough";
  goal.length = 4e-3;
  EXPECT_NEAR(movedBeside(targetsOf(goal, at.me)[1], goal, at), 0, 2.1e-3) << "at most half of its length";
}

TEST(BesideThreads, WhereSetsOfARowLieClosePatternsAreShorter) {
  Onlooker at;
  SutureSetGoal goal;
  goal.centre = {0.5, 0.3};
  const auto lengthWith = [&](double spacing) {
    goal.spacing = spacing;
    const std::vector<WallPoint> targets = targetsOf(goal, at.me);
    return -moved(targets.front(), targets.back(), at);
  };
  const AnatomicalMap& map = *at.me.seen_map;
  const double spacing = (map.position(map.at(0.53, 0.3)) - map.position(map.at(0.47, 0.3))).norm();
  const double length = lengthWith(0);
  EXPECT_EQ(lengthWith(0.5), length) << "there is room";
  EXPECT_GT(lengthWith(0.06), 0.6 * (spacing - kBesideThread));
  EXPECT_LT(lengthWith(0.06), 1.1 * (spacing - kBesideThread)) << "walked along a wall that bends";
  EXPECT_NEAR(lengthWith(1e-3), 0.5 * length, 1e-3) << "not shorter";
}

TEST(SetInHand, ABiteThatMissesSpoilsThePatternOnlyWhereEarlierOnesHaveMissed) {
  Onlooker at;
  SutureSetGoal goal;
  goal.centre = {0.5, 0.3};
  goal.length = 13e-3;
  SetInHand set{Technique::U, targetsOf(goal, at.me), 6};
  const std::shared_ptr<const AnatomicalMap> map = at.me.seen_map;
  const WallPoint beside = map->walk(set.points[6], 0, -12e-3);
  EXPECT_FALSE(set.isSpoiledBy(beside, *map));
  set.points[4] = map->walk(set.points[4], 0, -8e-3);
  set.points[5] = map->walk(set.points[5], 0, 8e-3);
  EXPECT_FALSE(set.isSpoiledBy(set.points[6], *map));
  EXPECT_TRUE(set.isSpoiledBy(beside, *map));
  set.pattern = Technique::C;
  EXPECT_FALSE(set.isSpoiledBy(beside, *map)) << "it was spoiled already";
  EXPECT_FALSE(SetInHand{}.isSpoiledBy(beside, *map)) << "a bite of its own";
}

// Bites 4 and 5 are the corners of a U of seven.
TEST(SetInHand, AGivenUpBiteIsTakenBesideItsTargetOnlyWhereThePatternNeedsIt) {
  Onlooker at;
  SutureSetGoal goal;
  goal.centre = {0.5, 0.3};
  goal.length = 13e-3;
  const std::shared_ptr<const AnatomicalMap> map = at.me.seen_map;
  SetInHand set{Technique::U, targetsOf(goal, at.me), 4};
  const std::optional<WallPoint> place = set.placeInstead(*map);
  ASSERT_TRUE(place.has_value());
  EXPECT_NEAR((map->position(*place) - map->position(set.points[4])).norm(), 10e-3, 2e-3);
  EXPECT_FALSE(set.isSpoiledBy(*place, *map));
  set.next = 1;
  EXPECT_FALSE(set.placeInstead(*map).has_value()) << "one bite less on a leg is still a U";
  set.next = 4;
  set.pattern = Technique::C;
  EXPECT_FALSE(set.placeInstead(*map).has_value()) << "no place makes it a C";
}

/// Steps for a motion under a force [N]; -1: stopped.
int stepsUnder(double force) {
  Onlooker at(Skill::expert(), [force](Observation& seen) { seen.force = {force, 0, 0}; });
  at.seen.force = {force, 0, 0};
  TraineeHand::Joints joints = at.hand.joints();
  joints[Insertion] += 0.05;
  return at.hand.feelTo(joints, 0.5) ? at.steps : -1;
}

TEST(FeelTo, IsSlowerTheMoreItFeelsAndStopsAtTheLimit) {
  const double limit = Skill::expert().force_limit;
  EXPECT_EQ(stepsUnder(0.5 * limit), stepsUnder(0));
  EXPECT_GT(stepsUnder(0.8 * limit), 1.5 * stepsUnder(0));
  EXPECT_GT(stepsUnder(0.95 * limit), 3 * stepsUnder(0));
  EXPECT_EQ(stepsUnder(1.01 * limit), -1);
}

}  // namespace
}  // namespace vibe::bite_tries_test
