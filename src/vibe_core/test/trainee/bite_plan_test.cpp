// What the trainee imagines before a bite, and the plan it makes of it.
#include "trainee/bite_plan.hpp"

#include <gtest/gtest.h>

#include "onlooker.hpp"
#include "trainee/ik_solution.hpp"
#include "trainee/picture.hpp"

namespace vibe::bite_plan_test {
namespace {

TraineeHand::Joints jointsOnWall(const Onlooker& at, const WallPoint& place) {
  const Eigen::Vector3d outward = at.me.outward(place), point = at.me.position(place) + kHelixDepth * outward;
  TraineeHand::Joints joints = aimAt(*smallStomach(), point, outward, helixInTip(kHelixOut), at.hand.joints()).joints;
  return reachFor(*smallStomach(), point, helixInTip(kHelixOut), joints).joints;
}

Eigen::Isometry3d tipAt(const TraineeHand::Joints& joints) {
  std::vector<Eigen::Isometry3d> poses;
  smallStomach()->tool->forwardKinematics(joints, poses);
  return smallStomach()->tool_base * poses[smallStomach()->tip_link];
}

TEST(ReachFor, BringsThePointThereWithLittleMotion) {
  const Onlooker at;
  const WallPoint place = at.me.seen_map->at(0.5, 0.3);
  const TraineeHand::Joints start = jointsOnWall(at, place);
  const Eigen::Vector3d offset = helixInTip(kHelixOut);
  const Eigen::Vector3d target = tipAt(start) * offset + Eigen::Vector3d(4e-3, -6e-3, 5e-3);
  const IkSolution reached = reachFor(*smallStomach(), target, offset, start);
  EXPECT_LT((tipAt(reached.joints) * offset - target).norm(), 1e-4);
  EXPECT_NEAR(reached.miss, (tipAt(reached.joints) * offset - target).norm(), 1e-9);
  for (int j = Rotation; j <= TipLeftRight; ++j) EXPECT_LT(std::abs(reached.joints[j] - start[j]), 0.3) << j;
  EXPECT_EQ(reached.joints[HelixAdvance], start[HelixAdvance]);
  EXPECT_GT(reachFor(*smallStomach(), target + Eigen::Vector3d(0, 0, 1), offset, start).miss, 0.5) << "out of reach";
}

TEST(Rolled, TurnsTheTipAroundItsAxisWhereItIs) {
  const Onlooker at;
  const TraineeHand::Joints start = jointsOnWall(at, at.me.seen_map->at(0.5, 0.3));
  int found = 0;
  for (const double angle : {-0.6, 0.4, 0.8}) {
    const auto joints = rolled(*smallStomach(), start, angle);
    if (!joints) continue;
    ++found;
    const Eigen::Isometry3d before = tipAt(start), after = tipAt(*joints);
    EXPECT_LT((after.translation() - before.translation()).norm(), 6e-3);
    const Eigen::AngleAxisd turn(Eigen::Matrix3d(before.linear().transpose() * after.linear()));
    EXPECT_NEAR(turn.angle() * turn.axis().x(), angle, 0.1);
    EXPECT_NEAR(turn.angle(), std::abs(angle), 0.1) << "and around nothing else";
  }
  EXPECT_GT(found, 0);
}

TEST(DistanceOfWall, IsOfTheWallNotOfItsParticles) {
  Onlooker at;
  const WallPoint place = at.me.seen_map->at(0.5, 0.3);
  const auto& corners = smallStomach()->organ.surface.triangles[place.triangle];
  const Eigen::Vector3d middle = (at.seen.wall[corners[0]] + at.seen.wall[corners[1]] + at.seen.wall[corners[2]]) / 3;
  const Eigen::Vector3d normal = (at.seen.wall[corners[1]] - at.seen.wall[corners[0]])
                                     .cross(at.seen.wall[corners[2]] - at.seen.wall[corners[0]])
                                     .normalized();
  const Eigen::Vector3d before = middle + 0.5e-3 * normal;
  double particle = 1;
  for (const Eigen::Vector3d& p : at.seen.wall) particle = std::min(particle, (p - before).norm());
  EXPECT_NEAR(distanceOfWall(before, *smallStomach(), at.seen), 0.5e-3, 1e-6);
  EXPECT_GT(particle, 1.5e-3);
}

TEST(ImagineNeedle, MoreDrawnMeansDeeper) {
  const Onlooker at;
  const WallPoint place = at.me.seen_map->at(0.5, 0.3);
  const Eigen::Quaterniond turn(tipAt(jointsOnWall(at, place)).linear());
  const auto depthAt = [&](double drawn, double follows) {
    const auto needle = imagineNeedle(*smallStomach(), at.seen, {place, turn, kHelixOut, drawn, follows});
    return needle ? needle->depth : -1;
  };
  EXPECT_LT(depthAt(20e-3, 0.14), 0) << "the wall is still before the arm";
  EXPECT_GT(depthAt(8e-3, 0.14), depthAt(14e-3, 0.14));
  EXPECT_GT(depthAt(2e-3, 0.14), 2e-3);
  EXPECT_GT(depthAt(2e-3, 0.14), depthAt(2e-3, 0.02)) << "a wall that does not follow leaves a narrow tent";
}

TEST(PlanBite, TheNeedleIsImaginedAtTheTargetAndDeep) {
  Onlooker at;
  for (const double around : {-1.0, 0.0, 1.0}) {
    const WallPoint target = at.me.seen_map->at(0.5, around);
    const BitePlan plan = planBite(target, at.me);
    ASSERT_TRUE(std::isfinite(plan.cost));
    EXPECT_LT(plan.miss, 2e-3);
    EXPECT_GT(plan.depth, 2.5e-3);
    const auto needle = imagineNeedle(
        *smallStomach(), at.seen, {plan.held, Eigen::Quaterniond(tipAt(plan.joints).linear()), kHelixOut, plan.drawn});
    ASSERT_TRUE(needle.has_value());
    EXPECT_LT((at.me.position(needle->where) - at.me.position(target)).norm(), 3e-3);
    const double beside = (at.me.position(plan.held) - at.me.position(target)).norm();
    EXPECT_GT(beside, 4e-3) << "the needle does not pass where the helix holds";
  }
}

TEST(PlanBite, EveryTurnOfTheDeviceIsImaginedInAStepOfItsOwn) {
  Skill half;
  half.foresight = 0.5;
  for (const auto& [skill, turns] : {std::pair{Skill::expert(), 12}, {half, 7}}) {
    Onlooker at(skill);
    planBite(at.me.seen_map->at(0.5, 0.0), at.me);
    EXPECT_LE(at.steps, turns);
    EXPECT_GE(at.steps, turns / 2) << "some turns are beyond the scope's limits";
  }
}

TEST(PlanBite, ASurpriseShiftsTheHelixTheOtherWay) {
  Onlooker at;
  const WallPoint target = at.me.seen_map->at(0.5, 0.0);
  at.seen.tip_turn = Eigen::Quaterniond(tipAt(jointsOnWall(at, target)).linear());
  const auto placeWith = [&](const Eigen::Vector2d& surprise) {
    at.me.surprise = surprise;
    const BitePlan plan = planBiteFromHere(target, at.me);
    return at.me.seen_map->alongWall(target, at.me.position(plan.held) - at.me.position(target));
  };
  const Eigen::Vector2d shift = placeWith({3e-3, 0}) - placeWith({0, 0});
  EXPECT_LT(shift[0], -1e-3);
}

TEST(PlanBite, WithoutForesightTheNeedleIsTakenToPassBesideTheHelix) {
  Skill skill;
  skill.foresight = 0;
  Onlooker novice(skill), expert;
  const WallPoint target = expert.me.seen_map->at(0.5, 0.0);
  const BitePlan plan = planBite(target, novice.me);
  const double beside = (novice.me.position(plan.held) - novice.me.position(target)).norm();
  EXPECT_GT(beside, 2e-3);
  EXPECT_LT(beside, 9e-3) << "the device's own offset, 7 mm";
  const auto needle =
      imagineNeedle(*smallStomach(), novice.seen,
                    {plan.held, Eigen::Quaterniond(tipAt(plan.joints).linear()), kHelixOut, plan.drawn});
  const auto missOf = [&](const std::optional<NeedleView>& view) {
    return view ? (expert.me.position(view->where) - expert.me.position(target)).norm() : 1.0;
  };
  EXPECT_GT(missOf(needle), 3e-3) << "but the wall that is drawn in carries the needle's place away";
}

}  // namespace
}  // namespace vibe::bite_plan_test
