// The helix is a corkscrew: turned in the wall that it holds, it goes round and the wall stays.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "vibe_testing/scope_worlds.hpp"

namespace vibe::helix_turn_test {
namespace {

using test::World;

constexpr double kRadius = 0.06;

World ballWorld(const std::string& model) {
  Scene scene;
  scene.tissue.model = model;
  scene.foundation = FoundationScene{};
  scene.scope = test::scopeFromAbove(kRadius);
  scene.helix = test::wideHelix();
  return test::scopeWorld(scene, test::openBall(kRadius, 3, 2.3e-3));
}

class HelixTurn : public ::testing::TestWithParam<const char*> {
 protected:
  HelixTurn() : world(ballWorld(GetParam())) {
    input.joints[Insertion] = 0.09;
    input.joints[HelixAdvance] = 0.028;
    world.run(1.5, input);
    input.buttons[HelixGrab] = 1;
    world.run(1, input);
    for (const GripPoint& point : world.state.grip) before.push_back(world.position(point.particle));
  }
  // Farthest way of a held particle [m].
  double moved() const {
    double max = 0;
    for (std::size_t i = 0; i < before.size(); ++i)
      max = std::max(max, (world.position(world.state.grip[i].particle) - before[i]).norm());
    return max;
  }
  World world;
  StepInput input;
  std::vector<Eigen::Vector3d> before;
};

TEST_P(HelixTurn, LeavesTheHeldPatchInPlace) {
  ASSERT_GT(before.size(), 2u) << "one particle could not be wound up";
  const Eigen::Vector3d torque = world.state.tool_torque;
  for (const double turns : {0.5, 1.25, 3.0}) {
    input.joints[HelixRotation] = 2 * M_PI * turns;
    world.run(0.5, input);
    ASSERT_NEAR(world.state.joints[HelixRotation], 2 * M_PI * turns, 1e-9);
    ASSERT_EQ(world.state.grip.size(), before.size());
    EXPECT_LT(moved(), 1e-6) << turns << " turns";
  }
  EXPECT_LT((world.state.tool_torque - torque).norm(), 1e-4);
}

TEST_P(HelixTurn, WhereTheWholeScopeTurnsItTakesThePatchAlong) {
  input.joints[Rotation] = 0.5;
  world.run(1, input);
  ASSERT_EQ(world.state.grip.size(), before.size());
  EXPECT_GT(moved(), 1e-3);
}

// Of the shell: mean place and mean slopes of what is held are those of the tool to a micrometre, and a single particle
// may move against it. Whole particles are held in shape matching.
TEST_P(HelixTurn, MeanPlaceAndSlopesMoveWithTheTool) {
  input.joints[Insertion] = 0.07;
  input.joints[Rotation] = 0.4;
  world.run(2, input);
  const std::vector<GripPoint>& grip = world.state.grip;
  ASSERT_EQ(grip.size(), before.size());
  ASSERT_GT(grip.size(), 3u);
  std::vector<Eigen::Isometry3d> poses;
  world.model->tool->forwardKinematics(world.state.joints, poses);
  const Eigen::Isometry3d tool = world.model->tool_base * poses[world.model->grip_link];
  Eigen::Vector3d middle = Eigen::Vector3d::Zero(), off = Eigen::Vector3d::Zero();
  double single = 0;
  for (const GripPoint& point : grip) {
    const Eigen::Vector3d error = world.position(point.particle) - tool * point.local;
    middle += point.weight * point.local;
    off += point.weight * error;
    if (point.weight >= wholeWeight(grip)) single = std::max(single, error.norm());
  }
  if (std::string(GetParam()) == "shape_matching") {
    EXPECT_LT(single, 1e-6);
    return;
  }
  EXPECT_LT(off.norm(), 1e-6);
  EXPECT_GT(single, 1e-5);
  Eigen::Matrix3d slope = Eigen::Matrix3d::Zero(), size = Eigen::Matrix3d::Zero();
  for (const GripPoint& point : grip) {
    const Eigen::Vector3d error = world.position(point.particle) - tool * point.local;
    slope += point.weight * error * (point.local - middle).transpose();
    size += point.weight * (point.local - middle) * (point.local - middle).transpose();
  }
  const Eigen::Matrix3d axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(size).eigenvectors();
  EXPECT_LT((slope * axes.rightCols<2>()).norm() / std::sqrt(size.trace()), 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Models, HelixTurn, ::testing::Values("shell", "shape_matching"));

}  // namespace
}  // namespace vibe::helix_turn_test
