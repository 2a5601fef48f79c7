// Joints of what is only drawn: an arm whose bars stay joined, a needle that is where the procedure has it, a probe
// that comes out with the pedal.
#include "vibe_core/simulation/tool_queries.hpp"

#include <gtest/gtest.h>
#include <urdf_parser/urdf_parser.h>

#include <cmath>
#include <map>

#include "procedure/procedure_bench.hpp"
#include "tool/kinematics.hpp"

namespace vibe::drawn_joints_test {
namespace {

using test::Bench;
using test::benchScene;

constexpr double kWay = 0.018;  // of needle_driver [m]
constexpr int kPlaces = 181;

std::map<std::string, double> drawnOf(const Model& model, const State& state) {
  std::map<std::string, double> positions;
  for (const DrawnJoint& joint : drawnJoints(model, state)) positions[joint.name] = joint.position;
  return positions;
}

/// Pose of a link in the root, where joints by name have these positions and the others are 0.
Eigen::Isometry3d poseOf(const ToolModel& tool, const std::string& link, const std::map<std::string, double>& at) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (int k = tool.linkIndex(link); k > 0; k = tool.joints()[k - 1].parent_link) {
    const ToolJoint& joint = tool.joints()[k - 1];
    const auto found = at.find(joint.name);
    const double position = found == at.end() ? 0 : found->second;
    Eigen::Isometry3d moved = joint.origin;
    if (joint.type == ToolJoint::Type::Prismatic) moved.translate(position * joint.axis);
    if (joint.type == ToolJoint::Type::Revolute) moved.rotate(Eigen::AngleAxisd(position, joint.axis));
    pose = moved * pose;
  }
  return pose;
}

double gap(const ToolModel& tool, const std::string& a, const std::string& b, std::map<std::string, double> at) {
  return (poseOf(tool, a, at).translation() - poseOf(tool, b, at).translation()).norm();
}

std::map<std::string, double> linkageAt(const ToolModel& tool, double driver) {
  const auto turns = needleLinkage(tool, driver);
  return {{"needle_driver", driver}, {"needle_arm_hinge", turns->arm}, {"needle_hook_turn", turns->hook}};
}

TEST(NeedleLinkage, ArmAndHookStayJoinedAndTurnSteadily) {
  const ToolModel tool = loadScope();
  double worst = 0, last = 0;
  for (int k = 0; k < kPlaces; ++k) {
    const auto at = linkageAt(tool, kWay * k / (kPlaces - 1));
    worst = std::max(worst, gap(tool, "needle_arm_pin", "needle_hook_pin", at));
    EXPECT_GE(at.at("needle_arm_hinge"), last - 1e-12) << "it does not turn back";
    EXPECT_LT(at.at("needle_arm_hinge") - last, 0.06) << "nor jumps";
    last = at.at("needle_arm_hinge");
  }
  EXPECT_LT(worst, 1e-9);
  EXPECT_NEAR(needleLinkage(tool, 0)->arm, 0, 1e-9) << "open as the meshes are";
  EXPECT_NEAR(needleLinkage(tool, 0)->hook, 0, 1e-9);
  EXPECT_GT(last, 1.5) << "it turns by more than a right angle";
  // control: a turn that is wrong by 3 degrees
  auto wrong = linkageAt(tool, 0.5 * kWay);
  wrong["needle_arm_hinge"] += 0.05;
  EXPECT_GT(gap(tool, "needle_arm_pin", "needle_hook_pin", wrong), 5e-4);
}

// Who knows the inputs only sees the arm joined at both ends of its way.
TEST(NeedleLinkage, WhatTheJointsMimicIsExactAtBothEnds) {
  const ToolModel tool = loadScope();
  std::vector<Eigen::Isometry3d> poses;
  const auto mimickedGap = [&](double driver) {
    std::array<double, kJointCount> inputs{};
    inputs[NeedleDriver] = driver;
    tool.forwardKinematics(inputs, poses);
    return (poses[tool.linkIndex("needle_arm_pin")].translation() -
            poses[tool.linkIndex("needle_hook_pin")].translation())
        .norm();
  };
  EXPECT_LT(mimickedGap(0), 1e-9);
  EXPECT_LT(mimickedGap(kWay), 1e-9);
  EXPECT_GT(mimickedGap(0.6 * kWay), 1e-3) << "control: in between it is rough";
}

TEST(NeedleLinkage, IsEmptyForAToolWithoutTheBars) {
  std::string other = scopeText();
  for (std::size_t at = other.find("needle_arm_hinge"); at != std::string::npos; at = other.find("needle_arm_hinge"))
    other.replace(at, 16, "another_joint");
  EXPECT_FALSE(needleLinkage(ToolModel::fromUrdf(other, "other.urdf"), 0.01));
}

struct Place {
  double needle_point;  ///< distance from the link needle [m]
  double draw;          ///< [m]
};

class DrawnNeedle : public ::testing::Test {
 protected:
  /// Where the drawn needle is beside the simulated one.
  Place place() {
    auto at = drawnOf(bench_.model(), bench_.state());
    at["needle_driver"] = bench_.state().joints[NeedleDriver];
    return {gap(*bench_.model().tool, "suture_needle", "needle", at), at.at("needle_draw")};
  }
  void expectOnArm() {
    EXPECT_LT(place().needle_point, 1e-12);
    EXPECT_EQ(place().draw, 0);
    const auto at = drawnOf(bench_.model(), bench_.state());
    EXPECT_EQ(at.at("needle_turn"), at.at("needle_hook_turn")) << "it turns with the hook";
  }
  Bench bench_;
};

TEST_F(DrawnNeedle, IsOnTheArmUntilTheExchangeTakesIt) {
  for (int k = 0; k <= 20; ++k) {
    bench_.moveArm(0.05 * k);
    expectOnArm();
  }
  bench_.press(Needle);
  ASSERT_FALSE(bench_.procedure().needle_on_arm);
  const Place held = place();
  EXPECT_NEAR(held.needle_point, 1.2e-3, 1e-12) << "drawn into the bore";
  EXPECT_NEAR(drawnOf(bench_.model(), bench_.state()).at("needle_turn"), 24 * 3.14159265358979 / 180, 1e-4)
      << "along the bore, see make_scope_urdf.py";
  bench_.openArm();
  EXPECT_GT(place().needle_point, 0.017) << "the arm opens without it";
  EXPECT_EQ(place().draw, held.draw);
  bench_.closeInAir();
  bench_.press(Needle);
  ASSERT_TRUE(bench_.procedure().needle_on_arm);
  expectOnArm();
  bench_.openArm();
  expectOnArm();
}

TEST_F(DrawnNeedle, IsGoneAfterTheTTagAndBackAfterTheCinch) {
  for (int k = 0; k < bench_.model().scene.suture->min_bites; ++k) bench_.bite(k);
  expectOnArm();
  bench_.press(TTag);
  ASSERT_FALSE(bench_.procedure().needle_loaded);
  const auto urdf = urdf::parseURDF(scopeText());
  EXPECT_EQ(place().draw, urdf->joints_.at("needle_draw")->limits->upper) << "the upper end says gone";
  bench_.press(Cinch);
  ASSERT_TRUE(bench_.procedure().needle_loaded);
  expectOnArm();
}

TEST(DrawnProbe, IsOutWhileThePedalIsDownAndEndsWhereTheBeamBegins) {
  Scene scene = benchScene();
  scene.marking = MarkingScene{};
  Bench bench(scene);
  const auto end = [&] { return drawnOf(bench.model(), bench.state()).at("argon_probe"); };
  bench.act();
  EXPECT_NEAR(end(), -0.005, 1e-12) << "in: what the joint mimics";
  bench.hold(ApcPedal);
  EXPECT_EQ(end(), scene.marking->apc.probe_length);
  std::map<std::string, double> at = drawnOf(bench.model(), bench.state());
  const Eigen::Vector3d begin =
      poseOf(*bench.model().tool, "scope_tip", at) * Eigen::Vector3d(scene.marking->apc.probe_length, 0, 0);
  EXPECT_LT((poseOf(*bench.model().tool, "argon_probe", at).translation() - begin).norm(), 1e-12);
  bench.hold(ApcPedal, false);
  EXPECT_NEAR(end(), -0.005, 1e-12);
}

TEST(DrawnProbe, StaysInWithoutAProbeInTheScene) {
  Bench bench;
  bench.hold(ApcPedal);
  EXPECT_NEAR(drawnOf(bench.model(), bench.state()).at("argon_probe"), -0.005, 1e-12);
}

// A tool of one's own need not have such parts.
TEST(DrawnJoints, AreThoseThatTheUrdfHas) {
  std::string without = scopeText();
  without.erase(without.find("  <!-- drawn "));
  const test::World world(benchScene(), test::plainOrgan(test::icosphere(0.03, 1), 2e-3), without + "</robot>");
  EXPECT_TRUE(drawnJoints(*world.model, world.state).empty());
  EXPECT_EQ(drawnJoints(Bench().model(), Bench().state()).size(), 6u);
}

}  // namespace
}  // namespace vibe::drawn_joints_test
