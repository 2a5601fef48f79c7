#include "vibe_core/simulation/tool_queries.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "vibe_testing/scope_worlds.hpp"

namespace vibe::tip_motion_test {
namespace {

using test::World;

constexpr double kRadius = 0.1;

World ballWithScope(double pitch = M_PI / 2) {
  Scene scene;
  scene.gas.reset();
  scene.gravity.reset();
  scene.scope = test::scopeFromAbove(kRadius);
  scene.scope->base_rpy = {0, pitch, 0};
  scene.scope->compliance = ScopeComplianceScene{};
  return test::scopeWorld(scene, test::openBall(kRadius, 4, 2e-3));
}

Eigen::Isometry3d tipOf(const Model& model, const State& state) {
  std::vector<Eigen::Isometry3d> poses;
  model.tool->forwardKinematics(state.joints, state.tool_displacement, poses);
  return model.tool_base * poses[model.tip_link];
}

TEST(TipMotion, JacobianIsHowTheTipMovesWithTheHand) {
  World world = ballWithScope();
  world.state.joints = {0.12, 0.4, 0.5, -0.3};
  for (const ToolDisplacement& displacement :
       {ToolDisplacement{}, ToolDisplacement{0.002, 0.1, -0.05, 0.08, 1.5, -0.4, -0.8, 0.3}}) {
    world.state.tool_displacement = displacement;
    const TipJacobian jacobian = tipJacobian(*world.model, world.state);
    constexpr double kStep = 1e-5;
    for (int j = 0; j < kScopeJointCount; ++j) {
      State more = world.state, less = world.state;
      more.joints[j] += kStep;
      less.joints[j] -= kStep;
      const Eigen::Isometry3d ahead = tipOf(*world.model, more), behind = tipOf(*world.model, less);
      const Eigen::Vector3d moved = (ahead.translation() - behind.translation()) / (2 * kStep);
      const Eigen::AngleAxisd turned(ahead.linear() * behind.linear().transpose());
      const Eigen::Vector3d spun = turned.angle() * turned.axis() / (2 * kStep);
      EXPECT_LT((jacobian.col(j).head<3>() - moved).norm(), 1e-7) << kJointNames[j];
      EXPECT_LT((jacobian.col(j).tail<3>() - spun).norm(), 1e-6) << kJointNames[j];
      EXPECT_GT(moved.norm() + spun.norm(), 0.1) << kJointNames[j];
    }
  }
}

TEST(TipMotion, LooksAtTheWallStraightAhead) {
  World world = ballWithScope();
  world.state.joints[Insertion] = 0.03;
  const Eigen::Vector3d tip = tipOf(*world.model, world.state).translation();
  const auto sight = lookAhead(*world.model, world.state);
  ASSERT_TRUE(sight);
  EXPECT_LT((sight->point - Eigen::Vector3d(0, 0, -kRadius)).norm(), 0.01 * kRadius);
  EXPECT_GT(sight->normal.z(), 0.99);
  EXPECT_NEAR(sight->distance, (sight->point - tip).norm(), 1e-12);
}

TEST(TipMotion, ATipInTheWallHasANegativeDistance) {
  World world = ballWithScope();
  world.state.joints[Insertion] = 0.03;
  const double free = lookAhead(*world.model, world.state)->distance;
  world.state.joints[Insertion] += free + 0.5 * world.model->particle_radius;
  const auto sight = lookAhead(*world.model, world.state);
  ASSERT_TRUE(sight);
  EXPECT_NEAR(sight->distance, -0.5 * world.model->particle_radius, 1e-9);
  EXPECT_GT(sight->normal.z(), 0.99) << "the side of the scope is where it came from";
}

TEST(TipMotion, SeesNothingWhereThereIsNoWall) {
  World away = ballWithScope(-M_PI / 2);
  away.state.joints[Insertion] = 0.2;  // out of the ball and on
  EXPECT_FALSE(lookAhead(*away.model, away.state));
  World world = ballWithScope();
  world.state.x.assign(world.state.x.size(), std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(lookAhead(*world.model, world.state));
}

}  // namespace
}  // namespace vibe::tip_motion_test
