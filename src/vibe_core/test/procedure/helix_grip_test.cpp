// Turns of the helix in the wall, and the force that they hold.
#include "vibe_core/procedure/helix_grip.hpp"

#include <gtest/gtest.h>

#include "vibe_core/files/files.hpp"
#include "vibe_testing/scope_worlds.hpp"

namespace vibe::helix_grip_test {
namespace {

using Kind = Event::Kind;

/// A helix that has just taken hold of a ball of tissue in front of it.
class HelixGrip : public ::testing::Test {
 protected:
  static Scene scene() {
    Scene scene = test::bareScene();
    scene.scope = ScopeScene{};
    scene.scope->base_from_anatomy = false;
    scene.helix = HelixScene{};
    scene.suture = SutureScene{};
    return scene;
  }

  HelixGrip()
      : world(scene(), test::plainOrgan(test::icosphere(0.03, 3), 2e-3),
              readTextFile(std::string(VIBE_DESCRIPTION_DIR) + "/urdf/scope.urdf", "URDF")) {
    world.model->tool->forwardKinematics(world.state.joints, poses);
    poses[world.model->helix_link].translation() = world.position(kTarget);
    updateGrip(*world.model, poses, true, world.state, {world.state, world.events});
  }

  void turnTo(double turns) {
    world.state.joints[HelixRotation] = 2 * M_PI * turns;
    releaseOverloadedGrip(*world.model, world.state, {world.state, world.events});
  }

  // The greatest force that it bears now, by trying.
  bool bears(double force) const {
    State state = world.state;
    std::vector<Event> events;
    state.grip_force = force;
    releaseOverloadedGrip(*world.model, state, {state, events});
    return !state.grip.empty();
  }

  static constexpr int kTarget = 100;
  test::World world;
  std::vector<Eigen::Isometry3d> poses;
};

TEST_F(HelixGrip, ReportsTheTargetedParticleAndItsNeighbours) {
  ASSERT_FALSE(world.state.grip.empty());
  EXPECT_EQ(world.state.grip.front().particle, kTarget);
  ASSERT_EQ(world.count(Kind::Grab), 1);
  EXPECT_EQ(world.events.front().particle, kTarget);
  EXPECT_EQ(world.events.front().value, static_cast<double>(world.state.grip.size()));
  double sum = 0;
  const double radius = world.model->scene.helix->grip_radius, whole = wholeWeight(world.state.grip);
  for (const GripPoint& point : world.state.grip) {
    sum += point.weight;
    if (point.weight < whole) continue;
    EXPECT_LE((world.position(point.particle) - world.position(kTarget)).norm(), radius);
  }
  EXPECT_NEAR(sum, 1, 1e-12);
  EXPECT_EQ(world.state.procedure.phase, Phase::Suture);
}

// What is held follows the tip of the helix, not the particles.
TEST_F(HelixGrip, HoldsTheWallWhereTheTipIs) {
  const std::array<int, 3> corners = world.model->organ.surface.triangles[40];
  Eigen::Vector3d last = Eigen::Vector3d::Zero();
  for (int k = 0; k <= 10; ++k) {
    updateGrip(*world.model, poses, false, world.state, {world.state, world.events});
    const double part = 0.1 * k;
    const Eigen::Vector3d tip = (1 - part) * world.position(corners[0]) + part * world.position(corners[1]);
    poses[world.model->helix_link].translation() = tip;
    updateGrip(*world.model, poses, true, world.state, {world.state, world.events});
    const Eigen::Vector3d held = test::heldPlace(world);
    EXPECT_LT((held - tip).norm(), 0.3e-3) << "the mean of a disc of 5 mm of a ball lies 0.2 mm below its middle";
    if (k > 0) {
      const double step = 0.1 * (world.position(corners[1]) - world.position(corners[0])).norm();
      EXPECT_NEAR((held - last).norm(), step, 0.2 * step) << part;
    }
    last = held;
  }
}

// In reach is the wall, however far its particles are.
TEST_F(HelixGrip, ReachesTheWallBetweenParticles) {
  const HelixScene& helix = *world.model->scene.helix;
  const auto& [a, b, c] = world.model->organ.surface.triangles[40];
  const Eigen::Vector3d middle = (world.position(a) + world.position(b) + world.position(c)) / 3;
  for (const double share : {0.99, 1.01}) {
    updateGrip(*world.model, poses, false, world.state, {world.state, world.events});
    poses[world.model->helix_link].translation() = middle - share * helix.reach * middle.normalized();
    updateGrip(*world.model, poses, true, world.state, {world.state, world.events});
    EXPECT_EQ(world.state.grip.empty(), share > 1);
    EXPECT_GT((poses[world.model->helix_link].translation() - world.position(a)).norm(), helix.reach);
  }
  EXPECT_NEAR(world.events.back().value, 1.01 * helix.reach, 1e-4);
}

TEST_F(HelixGrip, HoldsMoreWithEveryTurnUpToItsBest) {
  const HelixScene helix;
  const double per_turn = (helix.hold_force - helix.initial_hold_force) / helix.hold_turns;
  for (const double turns : {0.0, 0.5, 1.0, 2.0, 3.0, 4.0}) {
    turnTo(turns);
    const double want = std::min(helix.initial_hold_force + per_turn * turns, helix.hold_force);
    EXPECT_NEAR(holdingForce(helix, turns), want, 1e-12);
    EXPECT_TRUE(bears(want - 1e-6)) << turns;
    EXPECT_FALSE(bears(want + 1e-6)) << turns;
  }
  EXPECT_EQ(world.count(Kind::HelixTurned), 1);
}

TEST_F(HelixGrip, TurnedTheWrongWayItOnlyPricks) {
  turnTo(-3);
  EXPECT_FALSE(bears(0.51));
  EXPECT_TRUE(bears(0.49));
  EXPECT_EQ(world.state.procedure.grip_turns, 0);
}

TEST_F(HelixGrip, TurnedBackItKeepsItsHold) {
  turnTo(3);
  turnTo(1);
  turnTo(3);
  EXPECT_TRUE(bears(7.9));
  EXPECT_EQ(world.count(Kind::HelixTurned), 1);
}

TEST_F(HelixGrip, CountsFromWhereItTookHold) {
  updateGrip(*world.model, poses, false, world.state, {world.state, world.events});
  EXPECT_EQ(world.count(Kind::Release), 1);
  world.state.joints[HelixRotation] = 2 * M_PI * 3;
  updateGrip(*world.model, poses, true, world.state, {world.state, world.events});
  turnTo(4);
  EXPECT_NEAR(world.state.procedure.grip_turns, 1, 1e-12);
  EXPECT_FALSE(bears(holdingForce(HelixScene{}, 1) + 1e-6));
}

TEST_F(HelixGrip, ASlipSaysAtHowManyTurns) {
  turnTo(1.5);
  world.state.grip_force = 6;
  turnTo(1.5);
  ASSERT_EQ(world.count(Kind::Slip), 1);
  EXPECT_EQ(world.events.back().value, 6);
  EXPECT_NE(describe(world.events.back()).find("1.5 turns"), std::string::npos) << describe(world.events.back());
  EXPECT_TRUE(world.state.grip.empty());
}

TEST(HoldingForce, IsAllOfItAlwaysWithoutTurnsToHold) {
  HelixScene helix;
  helix.hold_turns = 0;
  EXPECT_EQ(holdingForce(helix, 0), helix.hold_force);
}

}  // namespace
}  // namespace vibe::helix_grip_test
