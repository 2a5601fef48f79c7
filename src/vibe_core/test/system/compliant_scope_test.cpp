// An endoscope that gives way, against tissue. A ball of tissue on a foundation stands in for the organ.
#include <gtest/gtest.h>

#include <algorithm>

#include "vibe_core/simulation/snapshot.hpp"
#include "vibe_testing/scope_worlds.hpp"

namespace vibe::compliant_scope_test {
namespace {

using test::World;

constexpr double kRadius = 0.06;

/// The scope enters at the top of the ball and looks down.
Scene scopeScene(std::optional<ScopeComplianceScene> compliance) {
  Scene scene = test::shellUnderScope(kRadius);
  scene.scope->compliance = compliance;
  scene.helix = test::firmHelix();
  return scene;
}

World scopeWorld(const Scene& scene) {
  return test::scopeWorld(scene, test::openBall(kRadius, 4, 2e-3));  // 4.6 mm between particles
}

StepInput at(double insertion, double up = 0, double left = 0) {
  StepInput input;
  input.joints[Insertion] = insertion;
  input.joints[TipUpDown] = up;
  input.joints[TipLeftRight] = left;
  return input;
}

Eigen::Vector3d tipOf(const World& world) {
  std::vector<Eigen::Isometry3d> poses;
  world.model->tool->forwardKinematics(world.state.joints, world.state.tool_displacement, poses);
  return world.model->tool_base * poses[world.model->tip_link].translation();
}

double springEnergy(const World& world) {
  return world.model->scope_springs->energy(world.state.joints, world.state.tool_displacement);
}

/// Nothing but the insertion gives way.
ScopeComplianceScene alongOnly() {
  ScopeComplianceScene compliance;
  compliance.axial_stiffness = 300;
  compliance.shaft_rigidity = compliance.torsional_rigidity = compliance.bending_stiffness = 1e4;
  return compliance;
}

TEST(CompliantScope, PressedOnTissueIsASpringInSeriesWithIt) {
  Scene soft_scene = scopeScene(alongOnly()), rigid_scene = scopeScene({});
  soft_scene.scope->friction = rigid_scene.scope->friction = 0;  // which would remember the way there
  World soft = scopeWorld(soft_scene), rigid = scopeWorld(rigid_scene);
  soft.run(3.0, at(0.14));
  const double force = -soft.state.tool_force.x(), given = -soft.state.tool_displacement[Insertion];
  EXPECT_GT(force, 0.3);
  EXPECT_NEAR(300 * given, force, 0.01 * force);
  EXPECT_NEAR(tipOf(soft).z(), kRadius - 0.14 + given, 1e-5);
  EXPECT_NEAR(soft.state.hand_effort[Insertion], force, 0.01 * force);
  rigid.run(3.0, at(0.14 - given));
  EXPECT_NEAR(-rigid.state.tool_force.x(), force, 0.01 * force) << "the tissue sees where the tip is, not the hand";
}

TEST(CompliantScope, EveryDegreeOfFreedomIsInEquilibrium) {
  World world = scopeWorld(scopeScene(ScopeComplianceScene{}));
  world.run(4.0, at(0.14, 0.5, 0.3));
  const ToolDisplacement& q = world.state.tool_displacement;
  const ScopeSprings& springs = *world.model->scope_springs;
  const YieldVector k = springs.stiffness(world.state.joints[Insertion] + q[Insertion]);
  for (int j = 0; j < kScopeJointCount; ++j) {
    const double effort = world.state.hand_effort[j], load = -k[j] * q[j];
    EXPECT_NEAR(load, effort, 0.02 * std::abs(effort) + 1e-4) << j;
  }
  for (int d = 0; d < kYieldDofs; ++d) {
    const double load = k[d] * q[d] - (d == Insertion ? springs.configurationalForce(world.state.joints, q) : 0);
    EXPECT_NEAR(world.state.tool_load[d], load, 0.02 * std::abs(load) + 1e-4) << d;
  }
  EXPECT_GT(std::abs(q[TipUpDown]), 0.02) << "the bending section gives way";
  EXPECT_GT(std::abs(q[kShaftDof]), 0.05) << "and so does the shaft";
}

TEST(CompliantScope, RigidOneStaysWhereTheHandIs) {
  Scene rigid_scene = scopeScene({});
  rigid_scene.scope->friction = 0;  // which would remember the way there
  World rigid = scopeWorld(rigid_scene);
  ScopeComplianceScene stiff;
  stiff.axial_stiffness = 1e7;
  stiff.shaft_rigidity = stiff.torsional_rigidity = stiff.bending_stiffness = 1e4;
  rigid_scene.scope->compliance = stiff;
  World nearly = scopeWorld(rigid_scene);
  for (World* world : {&rigid, &nearly}) world->run(2.0, at(0.125));
  for (double d : rigid.state.tool_displacement) EXPECT_EQ(d, 0);
  EXPECT_GT(rigid.state.hand_effort[Insertion], 0.1) << "the load at the hand is known without springs";
  EXPECT_LT((tipOf(rigid) - tipOf(nearly)).norm(), 1e-5);
}

TEST(CompliantScope, WithoutLoadItIsStraightAgain) {
  World world = scopeWorld(scopeScene(ScopeComplianceScene{}));
  world.run(2.0, at(0.14, 0.5));
  EXPECT_GT(springEnergy(world), 1e-5);
  world.run(3.0, at(0.05));
  for (double d : world.state.tool_displacement) EXPECT_LT(std::abs(d), 1e-6);
  EXPECT_EQ(world.state.hand_effort[Insertion], 0);
}

// work of the hand = work on the tissue + energy of the springs + losses of the scope
TEST(CompliantScope, WorkOfTheHandIsAccountedFor) {
  World world = scopeWorld(scopeScene(ScopeComplianceScene{}));
  StepInput from = at(0.1);
  for (const StepInput& input : {at(0.12), at(0.145), at(0.145, 0.8), at(0.145, 0.4, 0.6)}) {
    for (int i = 1; i <= 60; ++i) {  // within a step, the directions in which the scope yields stay as they are
      StepInput way = input;
      for (int j = 0; j < kJointCount; ++j)
        way.joints[j] = from.joints[j] + i / 60.0 * (input.joints[j] - from.joints[j]);
      world.step(way);
    }
    from = input;
    const EnergyAccount& energy = world.state.energy;
    const double missing = energy.hand_work - energy.tool_work - springEnergy(world) - energy.scope_loss;
    EXPECT_LT(std::abs(missing), 0.005 * std::abs(energy.hand_work) + 1e-6);
  }
  EXPECT_GT(springEnergy(world), 0.02 * world.state.energy.hand_work);
}

// The tip of a soft scope, pressed on a curved wall in half a second, is pushed aside along it.
TEST(CompliantScope, SlidesAlongTheWallAsInShortSteps) {
  constexpr std::size_t kFrames = 45;
  std::array<std::vector<Eigen::Vector3d>, 2> path;
  for (const int per_frame : {1, 16}) {
    Scene scene = scopeScene(ScopeComplianceScene{});
    scene.step_period = 1.0 / (60 * per_frame);
    scene.scope->friction = 0;
    scene.scope->compliance->shaft_rigidity = 0.005;
    World world = scopeWorld(scene);
    world.run(1.0, at(0.1, 0.3));
    for (int i = 1; i <= static_cast<int>(kFrames) * per_frame; ++i) {
      world.step(at(0.1 + 0.025 * std::min(1.0, i / (30.0 * per_frame)), 0.3));
      if (i % per_frame == 0) path[per_frame > 1].push_back(tipOf(world));
    }
  }
  double apart = 0;
  for (std::size_t k = 0; k < kFrames; ++k) apart = std::max(apart, (path[0][k] - path[1][k]).norm());
  EXPECT_LT(apart, 2e-4) << "with contacts where the scope was before the step: 6e-4";
  EXPECT_GT(path[1].front().x() - path[1].back().x(), 3e-3);
}

TEST(CompliantScope, HandsForceIsLimited) {
  Scene scene = scopeScene(ScopeComplianceScene{});
  scene.scope->compliance->shaft_rigidity = 10;  // or it buckles
  scene.foundation->stiffness = 1e7;             // a wall that does not give way
  World world = scopeWorld(scene);
  const double limit = 20;  // of a hand that feels the force, see HandModel::slowedByForce(); it could push with more
  ASSERT_GT(world.model->tool->limits()[Insertion].effort, limit);
  double most = 0;
  for (int i = 0; i < 300; ++i) {
    world.step(at(0.25));
    most = std::max(most, world.state.hand_effort[Insertion]);
  }
  EXPECT_GT(most, 0.9 * limit);
  EXPECT_LT(most, 1.05 * limit);
  EXPECT_LT(world.state.joints[Insertion], 0.2) << "the hand stalls";
}

TEST(CompliantScope, HelixPullsThroughIt) {
  Scene scenes[] = {scopeScene(ScopeComplianceScene{}), scopeScene({})};
  for (Scene& scene : scenes) scene.foundation->stiffness = 5e4;
  World soft = scopeWorld(scenes[0]), rigid = scopeWorld(scenes[1]);
  double moved[2];
  for (World* world : {&soft, &rigid}) {
    StepInput input = at(0.112);
    input.joints[HelixAdvance] = 0.01;
    world->run(2.0, input);
    input.buttons[HelixGrab] = 1;
    world->run(0.5, input);
    ASSERT_FALSE(world->state.grip.empty());
    const int held = world->state.grip.front().particle;
    const Eigen::Vector3d before = world->position(held);
    input.joints[TipUpDown] = 0.3;  // across the shaft
    world->run(3.0, input);
    moved[world == &rigid] = (world->position(held) - before).norm();
  }
  EXPECT_LT(moved[0], 0.9 * moved[1]) << "the tip lags behind the hand";
  EXPECT_GT(moved[0], 0.1 * moved[1]);
}

TEST(CompliantScope, StateCarriesAllOfIt) {
  const Scene scene = scopeScene(ScopeComplianceScene{});
  World world = scopeWorld(scene);
  world.run(1.5, at(0.14, 0.5));
  const std::string file = testing::TempDir() + "/compliant_scope.snapshot";
  saveSnapshot(*world.model, world.state, file);
  World other = scopeWorld(scene);
  other.state = loadSnapshot(*other.model, file);
  EXPECT_EQ(hash(other.state), hash(world.state));
  for (World* w : {&world, &other}) w->run(0.5, at(0.14, 0.2, 0.3));
  EXPECT_EQ(hash(other.state), hash(world.state));
  std::remove(file.c_str());
}

}  // namespace
}  // namespace vibe::compliant_scope_test
