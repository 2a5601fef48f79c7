// The endoscope against tissue: contact, friction, grip, wrench. A ball of tissue stands in for the organ.
#include <gtest/gtest.h>

#include <limits>

#include "tool/hand_model.hpp"
#include "tool/tool_motion.hpp"
#include "tool_contact/tool_collision.hpp"
#include "vibe_core/model/accounting.hpp"
#include "vibe_testing/scope_worlds.hpp"

namespace vibe::tool_test {
namespace {

using test::bareScene;
using test::scopeAt;
using test::World;

constexpr double kRadius = 0.06;

/// A ball on a foundation, the scope entering at the top and looking down.
Scene scopeScene() {
  Scene scene = bareScene();
  scene.tissue.mass_damping = 30;
  scene.tissue.stiffness_damping = 30e-6;
  scene.tissue.substeps = 60;
  scene.foundation = FoundationScene{};
  scene.foundation->stiffness = 2e4;
  scene.scope = test::scopeFromAbove(kRadius);
  scene.helix = test::firmHelix();
  return scene;
}

World scopeWorld(const Scene& scene = scopeScene()) {
  return test::scopeWorld(scene, test::openBall(kRadius, 4, 2e-3));  // 4.6 mm between particles
}

Eigen::Vector3d forceInWorld(const World& world) {
  std::vector<Eigen::Isometry3d> poses;
  world.model->tool->forwardKinematics(world.state.joints, poses);
  return (world.model->tool_base * poses[world.model->tip_link]).linear() * world.state.tool_force;
}

// Greatest depth of a particle below the surface of the tool's shapes.
double deepest(const World& world) {
  std::vector<Eigen::Isometry3d> poses;
  world.model->tool->forwardKinematics(world.state.joints, poses);
  for (Eigen::Isometry3d& pose : poses) pose = world.model->tool_base * pose;
  ToolCollision collision(*world.model->tool);
  const State& s = world.state;
  collision.findCandidates(poses, s.x.data(), s.y.data(), s.z.data(), world.model->particle_count, 0.01);
  double depth = 0;
  for (const Contact& c : collision.findContacts(poses, s.x.data(), s.y.data(), s.z.data(), 0.01))
    if (world.model->organ.end[c.particle] == End::None) depth = std::max(depth, -c.distance);
  return depth;
}

TEST(Tool, OutOfReachNothingHappens) {
  World world = scopeWorld();
  world.run(1.0, scopeAt(0.04));
  EXPECT_EQ(world.state.tool_force, Eigen::Vector3d::Zero());
  EXPECT_EQ(world.state.tool_torque, Eigen::Vector3d::Zero());
  EXPECT_LT(world.maxShift(), 1e-9);
  EXPECT_TRUE(world.events.empty());
}

TEST(Tool, PushesTissueAsideAndFeelsIt) {
  World world = scopeWorld();
  world.run(3.0, scopeAt(0.14));  // 2 cm beyond the wall opposite
  EXPECT_EQ(world.count(Event::Kind::ContactBegin), 1);
  EXPECT_EQ(world.count(Event::Kind::Recovery), 0);
  EXPECT_LT(deepest(world), 0.5e-3);
  EXPECT_GT(world.state.contact_count, 2);
  const Eigen::Vector3d force = forceInWorld(world);
  EXPECT_GT(force.z(), 0.05) << "the tissue pushes the scope back up";
  EXPECT_GT(force.z(), 2 * std::hypot(force.x(), force.y()));
}

TEST(Tool, AtRestTheForceIsWhatBedAndGravityCarry) {
  World world = scopeWorld();
  world.run(6.0, scopeAt(0.13));
  // equilibrium of the whole body: foundation force on the tissue + tool force on the tissue = 0
  Eigen::Vector3d foundation = Eigen::Vector3d::Zero();
  for (int i = 0; i < world.model->particle_count; ++i)
    foundation -= world.model->scene.foundation->stiffness * world.model->area[i] *
                  (world.position(i) - world.model->organ.surface.vertices[i]);
  ASSERT_GT(foundation.norm(), 0.02);
  EXPECT_LT((forceInWorld(world) - foundation).norm(), 0.02 * foundation.norm());
}

TEST(Tool, ThroughTheWallInOneFrameIsStoppedByItsOwnSpeedLimit) {
  World world = scopeWorld();
  world.step(scopeAt(0.30));
  EXPECT_NEAR(world.state.joints[Insertion], world.model->tool->limits()[Insertion].velocity / 60, 1e-12);
}

TEST(Tool, JointsStayWithinTheirLimits) {
  World world = scopeWorld();
  StepInput wild;
  wild.joints.fill(1e9);
  world.run(5.0, wild);
  for (int i = 0; i < kJointCount; ++i) EXPECT_EQ(world.state.joints[i], world.model->tool->limits()[i].upper);
  wild.joints.fill(std::numeric_limits<double>::quiet_NaN());
  world.run(0.1, wild);
  for (int i = 0; i < kJointCount; ++i) EXPECT_EQ(world.state.joints[i], world.model->tool->limits()[i].upper);
}

TEST(Tool, FrictionDragsTissueAlong) {
  double dragged[2];
  for (int k = 0; k < 2; ++k) {
    Scene scene = scopeScene();
    scene.scope->friction = k == 0 ? 0.0 : 0.6;
    World world = scopeWorld(scene);
    world.run(2.0, scopeAt(0.14));
    StepInput turned = scopeAt(0.14);
    turned.joints[Rotation] = 1.0;
    world.run(2.0, turned);
    Eigen::Vector3d torque = world.state.tool_torque;
    dragged[k] = torque.norm();
  }
  EXPECT_GT(dragged[1], 3 * dragged[0] + 1e-6);
}

class Grip : public ::testing::Test {
 protected:
  World world = scopeWorld();
  void takeHold() {
    world.run(1.5, scopeAt(0.095, 0.028));
    world.run(0.2, scopeAt(0.095, 0.028, true));
    ASSERT_EQ(world.count(Event::Kind::Grab), 1);
  }
};

TEST_F(Grip, HoldsPullsAndLetsGo) {
  takeHold();
  const int target = world.state.grip.front().particle;
  const Eigen::Vector3d before = world.position(target);
  world.run(2.0, scopeAt(0.075, 0.028, true));
  EXPECT_NEAR((world.position(target) - before).z(), 0.02, 1e-6) << "it moves with the helix";
  EXPECT_LT(forceInWorld(world).z(), -0.1) << "the tissue pulls the scope down";
  EXPECT_NEAR(world.state.grip_force, world.state.tool_force.norm(), 1e-9) << "nothing else touches";
  world.run(3.0, scopeAt(0.03, 0.028, false));
  EXPECT_EQ(world.count(Event::Kind::Release), 1);
  EXPECT_EQ(world.state.tool_force.norm(), 0);
  EXPECT_LT((world.position(target) - world.model->organ.surface.vertices[target]).norm(), 1e-3) << "it springs back";
}

TEST_F(Grip, WorkOfTheToolIsWhatTheTissueStores) {
  takeHold();
  const double work = world.state.energy.tool_work;
  const double balance = energyBalance(*world.model, world.state);
  world.run(6.0, scopeAt(0.075, 0.028, true));
  const double done = world.state.energy.tool_work - work;
  ASSERT_GT(done, 1e-3);
  EXPECT_NEAR(energyBalance(*world.model, world.state), balance, 0.03 * done);
}

TEST_F(Grip, SlipsAboveItsHoldForce) {
  takeHold();
  world.run(1.0, scopeAt(0.0, 0.0, true));
  EXPECT_EQ(world.count(Event::Kind::Slip), 1);
  EXPECT_TRUE(world.state.grip.empty());
  world.run(0.5, scopeAt(0.0, 0.0, true));
  EXPECT_EQ(world.count(Event::Kind::Grab), 1) << "a held button does not grab again";
}

TEST_F(Grip, MissesInTheAir) {
  world.run(0.5, scopeAt(0.02));
  world.run(0.2, scopeAt(0.02, 0, true));
  EXPECT_EQ(world.count(Event::Kind::GrabMissed), 1);
  EXPECT_EQ(world.count(Event::Kind::Grab), 0);
  EXPECT_TRUE(world.state.grip.empty());
}

TEST(HandModel, GoesNoFasterThanTheLimit) {
  World world = scopeWorld();
  const ToolModel& tool = *world.model->tool;
  const HandModel hand(tool, nullptr);
  std::array<double, kJointCount> position{}, command{};
  command[Insertion] = 0.1;
  EXPECT_DOUBLE_EQ(hand.withinLimits(position, command, 0.01)[Insertion], tool.limits()[Insertion].velocity * 0.01);
  command[Insertion] = 1e-5;
  EXPECT_DOUBLE_EQ(hand.withinLimits(position, command, 0.01)[Insertion], 1e-5);
  command[Insertion] = -1;
  EXPECT_DOUBLE_EQ(hand.withinLimits(position, command, 0.01)[Insertion], tool.limits()[Insertion].lower);
}

}  // namespace
}  // namespace vibe::tool_test
