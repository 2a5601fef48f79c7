#include "tool/tool_motion.hpp"

#include <gtest/gtest.h>

#include "vibe_testing/scope_fixture.hpp"

namespace vibe::tool_jacobian_test {
namespace {

TEST(ToolJacobian, IsHowPointsOfEveryLinkMove) {
  const ToolModel tool = loadScope();
  const std::array<double, kJointCount> inputs = {0.07, 0.4, 0.5, -0.3, 0.01, 0.8, 0.004};
  const Eigen::Vector3d local(0.01, -0.02, 0.005);
  std::vector<Eigen::Isometry3d> poses, ahead, behind;
  tool.forwardKinematics(inputs, poses);
  // the drawn arm turns by 109 rad/m, so a difference over 1e-5 is not yet a derivative
  constexpr double kStep = 1e-6;
  for (int link = 0; link < tool.linkCount(); ++link) {
    const auto jacobian = pointJacobian(tool, poses, link, poses[link] * local);
    for (int j = 0; j < kJointCount; ++j) {
      auto more = inputs, less = inputs;
      more[j] += kStep;
      less[j] -= kStep;
      tool.forwardKinematics(more, ahead);
      tool.forwardKinematics(less, behind);
      const Eigen::Vector3d moved = (ahead[link] * local - behind[link] * local) / (2 * kStep);
      EXPECT_LT((jacobian.col(j) - moved).norm(), 1e-8) << tool.linkName(link) << ", " << kJointNames[j];
    }
  }
  EXPECT_GT(pointJacobian(tool, poses, tool.linkIndex("scope_tip"), Eigen::Vector3d::Zero()).col(TipUpDown).norm(), 0);
}

// The power of force and torque on a link that moves with the tool's displacement.
TEST(ToolJacobian, YieldForceIsThePowerPerMotion) {
  const ToolModel tool = loadScope();
  const std::array<double, kJointCount> inputs = {0.12, 0.4, 0.5, -0.3};
  const ToolDisplacement at = {0.002, 0.1, -0.05, 0.08, 1.5, -0.4, -0.8, 0.3};
  const Eigen::Vector3d force(0.3, -1.1, 0.7), torque(0.02, 0.05, -0.03);
  std::vector<Eigen::Isometry3d> poses, ahead, behind;
  tool.forwardKinematics(inputs, at, poses);
  constexpr double kStep = 1e-5;
  for (const char* name : {"scope_neck", "scope_tip"}) {
    const int link = tool.linkIndex(name);
    const YieldVector given =
        yieldForce(tool, poses, tool.shaftBend(inputs, at), link, poses[link].translation(), force, torque);
    for (int d = 0; d < kYieldDofs; ++d) {
      ToolDisplacement more = at, less = at;
      more[d] += kStep;
      less[d] -= kStep;
      tool.forwardKinematics(inputs, more, ahead);
      tool.forwardKinematics(inputs, less, behind);
      const Eigen::Vector3d moved = (ahead[link].translation() - behind[link].translation()) / (2 * kStep);
      const Eigen::AngleAxisd turned(ahead[link].linear() * behind[link].linear().transpose());
      const double power = force.dot(moved) + torque.dot(turned.angle() * turned.axis()) / (2 * kStep);
      EXPECT_NEAR(given[d], power, 1e-7) << name << ", " << d;
    }
  }
}

}  // namespace
}  // namespace vibe::tool_jacobian_test
