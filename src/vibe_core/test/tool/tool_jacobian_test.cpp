#include "tool/tool_motion.hpp"

#include <gtest/gtest.h>

#include "vibe_testing/scope_fixture.hpp"

namespace vibe::tool_jacobian_test {
namespace {

void expectMotion(NeedleArm arm) {
  const ToolModel tool = ToolModel::fromUrdf(scopeText(), "scope.urdf", arm);
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

TEST(ToolJacobian, IsHowPointsOfEveryLinkMove) {
  expectMotion(NeedleArm::Drawn);
}

TEST(ToolJacobian, IsSoWithANeedleArmThatIsABody) {
  expectMotion(NeedleArm::Body);
}

TEST(ToolJacobian, ANeedleArmThatIsABodyHoldsTogether) {
  for (const auto arm : {NeedleArm::Drawn, NeedleArm::Body}) {
    const ToolModel tool = ToolModel::fromUrdf(scopeText(), "scope.urdf", arm);
    double farthest = 0;
    for (double driver = 0; driver <= 0.018; driver += 1e-3) {
      std::vector<Eigen::Isometry3d> poses;
      tool.forwardKinematics({0, 0, 0, 0, 0, 0, driver}, poses);
      const Eigen::Vector3d apart = poses[static_cast<std::size_t>(tool.linkIndex("needle_arm_pin"))].translation() -
                                    poses[static_cast<std::size_t>(tool.linkIndex("needle_hook_pin"))].translation();
      farthest = std::max(farthest, apart.norm());
    }
    if (arm == NeedleArm::Body)
      EXPECT_LT(farthest, 1e-9);
    else
      EXPECT_GT(farthest, 4e-3) << "control: the mimic elements only come near";
  }
}

}  // namespace
}  // namespace vibe::tool_jacobian_test
