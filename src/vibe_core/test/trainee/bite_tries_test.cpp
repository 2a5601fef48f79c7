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

TEST(BesideThreads, ATargetMovesAlongTheOrganAwayFromAnEarlierBite) {
  Onlooker at;
  const AnatomicalMap& map = *at.me.seen_map;
  const WallPoint target = map.at(0.5, 0.3);
  EXPECT_EQ(moved(target, besideThreads(target, 10e-3, at.me), at), 0) << "no thread";
  at.me.stitches = {map.walk(target, 3e-3, 0)};
  EXPECT_NEAR(moved(target, besideThreads(target, 10e-3, at.me), at), 3e-3 - kBesideThread, 1.5e-3);
  EXPECT_NEAR(moved(target, besideThreads(target, 2e-3, at.me), at), -2e-3, 0.3e-3) << "at most so far";
  at.me.stitches = {map.walk(target, -3e-3, 0)};
  EXPECT_NEAR(moved(target, besideThreads(target, 10e-3, at.me), at), kBesideThread - 3e-3, 1.5e-3);
  at.me.stitches = {map.walk(target, 12e-3, 0)};
  EXPECT_EQ(moved(target, besideThreads(target, 10e-3, at.me), at), 0) << "far enough";
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
