#include "input/tip_velocity.hpp"

#include <gtest/gtest.h>

#include "input/input_interpreter.hpp"
#include "input/input_queue.hpp"
#include "vibe_testing/scope_worlds.hpp"

namespace vibe::sim::tip_velocity_test {
namespace {

constexpr double kFrame = 1.0 / 60;

class TipVelocityTest : public testing::Test {
 protected:
  test::World world = test::scopeWorld(test::shellUnderScope(0.06), test::openBall(0.06, 2, 2e-3));
  JointArray joints{0.06, 0.2, 0.3, -0.2, 0, 0, 0};

  Eigen::Isometry3d tip() const {
    std::vector<Eigen::Isometry3d> poses;
    world.model->tool->forwardKinematics(joints, poses);
    return world.model->tool_base * poses[static_cast<std::size_t>(world.model->tip_link)];
  }
  void go(const Eigen::Matrix<double, 6, 1>& twist, int frames) {
    for (int i = 0; i < frames; ++i) joints = afterTwist(*world.model, joints, twist, kFrame);
  }
};

TEST_F(TipVelocityTest, TheTipGoesWhereTheVelocityPoints) {
  for (const Eigen::Vector3d& v : {Eigen::Vector3d(1e-3, 0, 0), Eigen::Vector3d(0, 2e-3, 0),
                                   Eigen::Vector3d(0, 0, -5e-3), Eigen::Vector3d(2e-3, -3e-3, 4e-3)}) {
    joints = {0.06, 0.2, 0.3, -0.2, 0, 0, 0};
    const Eigen::Vector3d start = tip().translation();
    Eigen::Matrix<double, 6, 1> twist;
    twist << v, Eigen::Vector3d::Zero();
    go(twist, 120);
    EXPECT_LT((tip().translation() - start - 2 * v).norm(), 0.02 * 2 * v.norm());
  }
}

TEST_F(TipVelocityTest, WhatTheFourthJointCanTurnItTurns) {
  joints = {0.06, 0, 0, 0, 0, 0, 0};  // straight: the shaft turns the tip about its axis
  const Eigen::Isometry3d start = tip();
  Eigen::Matrix<double, 6, 1> twist = Eigen::Matrix<double, 6, 1>::Zero();
  twist.tail<3>() = 0.5 * start.linear().col(0);
  go(twist, 60);
  EXPECT_NEAR(joints[Rotation], 0.5, 0.01);
  EXPECT_LT((tip().translation() - start.translation()).norm(), 1e-6);
}

TEST_F(TipVelocityTest, NoJointIsFasterThanItsLimitAndNoneLeavesItsRange) {
  Eigen::Matrix<double, 6, 1> twist = Eigen::Matrix<double, 6, 1>::Zero();
  twist.head<3>() << 9, 9, -9;
  for (int i = 0; i < 600; ++i) {
    const JointArray before = joints;
    joints = afterTwist(*world.model, joints, twist, kFrame);
    for (std::size_t j = 0; j < kScopeJointCount; ++j) {
      const JointLimits& limit = world.model->tool->limits()[j];
      ASSERT_LE(std::abs(joints[j] - before[j]), limit.velocity * kFrame * (1 + 1e-9));
      ASSERT_GE(joints[j], limit.lower);
      ASSERT_LE(joints[j], limit.upper);
    }
  }
}

TEST_F(TipVelocityTest, AVelocityLastsUntilTheNextMessageForTheJoints) {
  InputQueue queue;
  InputInterpreter interpreter;
  StepInput input;
  input.joints = joints;
  std::int64_t stamp = 1'000'000'000;
  const auto frame = [&] {
    stamp += 16'666'667;
    const double before = input.joints[Insertion];
    EXPECT_TRUE(interpreter.interpret(queue.takeDue(stamp), *world.model, input).empty());
    return input.joints[Insertion] - before;
  };
  frame();
  InputSample down;
  down.target = ScopeTarget::VelocityInWorld;
  down.tip_twist << 0, 0, -6e-3, 0, 0, 0;
  for (int i = 0; i < 30; ++i) {
    if (i % 10 == 0) {
      ASSERT_TRUE(queue.push(down));
    }
    EXPECT_NEAR(frame(), 1e-4, 3e-5);
  }
  InputSample joints_sample;
  joints_sample.joints = input.joints;
  ASSERT_TRUE(queue.push(joints_sample));
  for (int i = 0; i < 3; ++i) EXPECT_EQ(frame(), 0);
  ASSERT_TRUE(queue.push(down));
  EXPECT_GT(frame(), 0);
  interpreter.endMoves();
  EXPECT_EQ(frame(), 0);
}

}  // namespace
}  // namespace vibe::sim::tip_velocity_test
