// The shaft of the endoscope as a chain of joints: a beam that is clamped where it enters.
#include "vibe_core/tool/tool_model.hpp"

#include <gtest/gtest.h>

#include "tool/tool_motion.hpp"
#include "vibe_testing/scope_fixture.hpp"

namespace vibe::shaft_bend_test {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

const std::vector<double> kStations = {0, 0.034, 0.068, 0.102, 0.136, 0.17, 0.204};

/// Rotation and deflection of the end, for small angles, summed over the joints.
struct EndOfShaft {
  double slope = 0, deflection = 0;
  EndOfShaft(const std::vector<double>& stations, double length, const ToolDisplacement& displacement, int direction) {
    const ShaftBend bend(stations, length, displacement);
    for (std::size_t i = 0; i < stations.size(); ++i) {
      slope += bend.angle(static_cast<int>(i), direction);
      deflection += bend.angle(static_cast<int>(i), direction) * stations[i];
    }
  }
};

// curvature mean + change (1 - 2 m / L) at the distance m from the end: its integral and its first moment
TEST(ShaftBend, EndRotatesAndMovesLikeThatOfTheBeam) {
  for (double length : {0.003, 0.034, 0.05, 0.12, 0.2015}) {
    ToolDisplacement q{};
    q[kShaftDof] = 0.7, q[kShaftDof + 1] = 0.4, q[kShaftDof + 2] = -0.2, q[kShaftDof + 3] = 1.1;
    for (int direction = 0; direction < 2; ++direction) {
      const double mean = q[kShaftDof + 2 * direction], change = q[kShaftDof + 2 * direction + 1];
      const EndOfShaft end(kStations, length, q, direction);
      EXPECT_NEAR(end.slope, mean * length, 1e-12);
      EXPECT_NEAR(end.deflection, (mean / 2 - change / 6) * length * length, 1e-12) << length;
    }
  }
}

TEST(ShaftBend, NothingBendsOutsideTheLumen) {
  ToolDisplacement q{};
  q.fill(1);
  const ShaftBend bend(kStations, -0.02, q);
  for (int i = 0; i < 7; ++i) EXPECT_EQ(bend.angle(i, 0), 0);
  const ShaftBend shallow(kStations, 0.05, q);
  EXPECT_NE(shallow.angle(2, 0), 0) << "the joint at the entry takes what is nearest to it";
  for (int i = 3; i < 7; ++i) EXPECT_EQ(shallow.angle(i, 0), 0);
}

TEST(ShaftBend, RatesAreThoseOfTheFreeLength) {
  ToolDisplacement q{};
  q[kShaftDof] = 2, q[kShaftDof + 1] = -1.5;
  for (double length : {0.02, 0.06, 0.15}) {
    const ShaftBend here(kStations, length, q), longer(kStations, length + 1e-6, q),
        shorter(kStations, length - 1e-6, q);
    for (int i = 0; i < 7; ++i)
      EXPECT_NEAR(here.angleRate(i, 0), (longer.angle(i, 0) - shorter.angle(i, 0)) / 2e-6, 1e-6) << length << ", " << i;
  }
}

TEST(ShaftBend, JacobianIsHowPointsOfEveryLinkMove) {
  const ToolModel tool = loadScope();
  ASSERT_EQ(tool.shaftStations().size(), 7u);
  const std::array<double, kJointCount> inputs = {0.21, 0.4, 0.5, -0.3, 0.01, 0.8, 0.004};
  const ToolDisplacement q = {-0.004, 0.1, 0.2, -0.1, 3.0, -1.5, 2.0, 4.0};
  const Vector3d local(0.01, -0.02, 0.005);
  std::vector<Isometry3d> poses, ahead, behind;
  tool.forwardKinematics(inputs, q, poses);
  for (int link = 0; link < tool.linkCount(); ++link) {
    const auto jacobian = yieldJacobian(tool, poses, tool.shaftBend(inputs, q), link, poses[link] * local);
    for (int d = 0; d < kYieldDofs; ++d) {
      ToolDisplacement more = q, less = q;
      more[d] += 1e-6;
      less[d] -= 1e-6;
      tool.forwardKinematics(inputs, more, ahead);
      tool.forwardKinematics(inputs, less, behind);
      const Vector3d moved = (ahead[link] * local - behind[link] * local) / 2e-6;
      EXPECT_LT((jacobian.col(d) - moved).norm(), 1e-7) << tool.linkName(link) << ", " << d;
    }
  }
}

TEST(ShaftBend, DisplacementsAreAddedToTheInputsAndStraightScopesStay) {
  const ToolModel tool = loadScope();
  std::vector<Isometry3d> moved, same, plain;
  tool.forwardKinematics({0.2, 0.3, 0.4, 0.5}, {0.01, -0.1, 0.2, -0.3}, moved);
  tool.forwardKinematics({0.21, 0.2, 0.6, 0.2}, same);
  for (std::size_t link = 0; link < moved.size(); ++link)
    EXPECT_LT((moved[link].matrix() - same[link].matrix()).norm(), 1e-12);
  tool.forwardKinematics({0.2, 0.3, 0.4, 0.5}, ToolDisplacement{}, same);
  tool.forwardKinematics({0.2, 0.3, 0.4, 0.5}, plain);
  for (std::size_t link = 0; link < moved.size(); ++link) EXPECT_EQ(same[link].matrix(), plain[link].matrix());
}

}  // namespace
}  // namespace vibe::shaft_bend_test
