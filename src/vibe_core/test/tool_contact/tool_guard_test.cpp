// The guard of the tool, without contacts and solver.
#include "tool_contact/tool_guard.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "tool_contact/sheet_scene.hpp"

namespace vibe::tool_guard_test {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using namespace test::sheet;

// The guard alone, without contacts: wall and tool in random motion.
TEST(ToolGuard, NothingPassesWhateverMoves) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> c(-1, 1), fast(0, 0.2);
  SheetScene scene(0.3e-3, 6);
  ToolGuard guard(scene.tool, scene.mesh, scene.thickness, scene.none);
  const Isometry3d base = Isometry3d::Identity();
  int stopped = 0, passing = 0;
  for (int trial = 0; trial < 150; ++trial) {
    std::array<double, kJointCount> from{}, to{};
    from[Insertion] = 0.1;
    to[Insertion] = 0.1 + fast(random);
    to[TipUpDown] = 0.3 * c(random);
    to[TipLeftRight] = 0.3 * c(random);
    const ToolMotion motion(scene.tool, base, from, to);
    ToolPoses poses;
    motion.linkPoses(0, poses.start);
    motion.linkPoses(1, poses.end);
    const Vector3d tip = poses.start[scene.tool.linkIndex("scope_tip")] * Vector3d(0.01, 0, 0);
    Points wall = scene.start, moved;
    const Vector3d shift(tip.x() + 1e-3 + 5e-3 * std::abs(c(random)), tip.y() + 4e-3 * c(random),
                         tip.z() + 4e-3 * c(random));
    for (std::size_t k = 0; k < 3; ++k)
      for (double& x : wall[k]) x += shift[static_cast<int>(k)];
    moved = wall;
    const double pushed = -0.03 * std::abs(c(random));
    for (double& x : moved[0]) x += pushed;  // towards the tool
    const auto crosses = [&](const ToolMotion& made, double tool_part, double wall_part) {
      constexpr int kMoments = 60;
      LinkPoses at;
      for (int moment = 0; moment <= kMoments; ++moment) {
        made.linkPoses(tool_part * moment / kMoments, at);
        const Isometry3d& pose = at[scene.tool.linkIndex("scope_tip")];
        for (const auto& n : scene.contacts.triangles()) {
          std::array<Vector3d, 3> t;
          for (std::size_t i = 0; i < 3; ++i) t[i] = pathOf(wall, moved).at(n[i], wall_part * moment / kMoments);
          if (segmentTriangleGap(pose.translation(), pose * Vector3d(0.01, 0, 0), t).distance == 0) return true;
        }
      }
      return false;
    };
    ASSERT_FALSE(crosses(motion, 0, 0));
    passing += crosses(motion, 1, 1) ? 1 : 0;
    ToolMotion made = motion;
    const double free = guard.separate(poses, made, pathOf(wall, moved), {});
    EXPECT_FALSE(crosses(made, 1, free)) << "trial " << trial;
    stopped += made.inputs(1) != motion.inputs(1) || free < 1 ? 1 : 0;
    LinkPoses reached;
    made.linkPoses(1, reached);
    EXPECT_TRUE(reached.poses.back().isApprox(poses.end.poses.back()));
  }
  EXPECT_GT(passing, 50) << "without the guard they cross";
  EXPECT_GE(stopped, passing);
}

/// A tool whose front is 1 mm before a sheet, and joints that can be commanded.
class StuckTool : public testing::Test {
 protected:
  StuckTool() : scene_(kRadius, 6), guard_(scene_.tool, scene_.mesh, scene_.thickness, scene_.none), joints_{0.1} {
    poses_.resize(static_cast<std::size_t>(scene_.tool.linkCount()));
    scene_.tool.forwardKinematics(joints_, poses_);
    const Vector3d front = poses_[scene_.tool.linkIndex("scope_tip")] * scene_.front;
    wall_ = scene_.start;
    for (std::size_t k = 0; k < 3; ++k)
      for (double& x : wall_[k]) x += front[static_cast<int>(k)] + (k == 0 ? 1e-3 : 0);
  }
  /// @param push  of the wall towards the tool [m]
  /// @returns the part of its way that the wall can go
  double moveTo(const std::array<double, kJointCount>& command, const std::vector<int>& held = {}, double push = 0) {
    ToolMotion motion(scene_.tool, Isometry3d::Identity(), joints_, command);
    ToolPoses poses;
    motion.linkPoses(0, poses.start);
    motion.linkPoses(1, poses.end);
    Points pushed = wall_;
    for (double& x : pushed[0]) x -= push;
    const double free = guard_.separate(poses, motion, pathOf(wall_, pushed), held);
    joints_ = motion.inputs(1);
    for (double& x : wall_[0]) x -= free * push;
    return free;
  }
  double outside() {
    scene_.tool.forwardKinematics(joints_, poses_);
    return wall_[0][0] - (poses_[scene_.tool.linkIndex("scope_tip")] * scene_.front).x();
  }

  /// Vertices of the sheet whose distance from the axis of the tool is below, or not below, a radius [m].
  std::vector<int> verticesAround(double radius, bool inside) const {
    std::vector<int> found;
    const Vector3d front = poses_[scene_.tool.linkIndex("scope_tip")] * scene_.front;
    for (std::size_t v = 0; v < wall_[0].size(); ++v)
      if ((std::hypot(wall_[1][v] - front.y(), wall_[2][v] - front.z()) < radius) == inside)
        found.push_back(static_cast<int>(v));
    return found;
  }

  static constexpr double kRadius = 0.5e-3;
  SheetScene scene_;
  ToolGuard guard_;
  std::array<double, kJointCount> joints_;
  std::vector<Isometry3d> poses_;
  Points wall_;
};

TEST_F(StuckTool, JointsThatAreFreeGoOn) {
  auto command = joints_;
  command[Insertion] += 5e-3;
  command[Rotation] += 0.3;
  EXPECT_EQ(moveTo(command), 1);
  EXPECT_DOUBLE_EQ(joints_[Rotation], command[Rotation]) << "the tool turns about its own axis";
  EXPECT_LT(joints_[Insertion], 0.1011);
  EXPECT_GT(outside(), 0);
}

// The wall would run into the tool and stops on its way. The joints are tried against what it goes, not against all of
// it, which none of them could bear.
TEST_F(StuckTool, JointsGoOnWhereTheWallIsStopped) {
  auto command = joints_;
  command[Insertion] += 5e-3;
  command[Rotation] += 0.3;
  const double free = moveTo(command, {}, 20e-3);
  EXPECT_GT(free, 0.5e-3 / 20e-3) << "it comes to the tool";
  EXPECT_LT(free, 1e-3 / 20e-3);
  EXPECT_DOUBLE_EQ(joints_[Rotation], command[Rotation]) << "the tool turns about its own axis";
  EXPECT_LT(joints_[Insertion], 0.101);
  EXPECT_GT(outside(), 0);
}

TEST_F(StuckTool, YieldsToAWallThatIsFaster) {
  auto command = joints_;
  command[Insertion] -= 5e-3;
  EXPECT_LT(moveTo(command, {}, 20e-3), 1);
  EXPECT_DOUBLE_EQ(joints_[Insertion], command[Insertion]);
  EXPECT_GT(outside(), 5e-3);
}

TEST_F(StuckTool, WhatTheHelixHoldsIsDrawnIntoTheDevice) {
  auto command = joints_;
  command[Insertion] += 5e-3;
  std::vector<int> all(wall_[0].size());
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(moveTo(command, all), 1);
  EXPECT_DOUBLE_EQ(joints_[Insertion], command[Insertion]);
}

TEST_F(StuckTool, GetsFreeHoweverLongItHasBeenPushed) {
  auto command = joints_;
  for (int k = 0; k < 600; ++k) {
    command[Insertion] = joints_[Insertion] + 5e-3;
    moveTo(command);
  }
  EXPECT_GT(outside(), 1e-7);
  EXPECT_LT(outside(), 0.1 * kThickness);
  command[Insertion] = joints_[Insertion] - 5e-3;
  moveTo(command);
  EXPECT_DOUBLE_EQ(joints_[Insertion], command[Insertion]);
}

TEST_F(StuckTool, HoldingWhatIsElsewhereDoesNotLetItPass) {
  auto command = joints_;
  command[Insertion] += 5e-3;
  EXPECT_EQ(moveTo(command, verticesAround(8e-3, false)), 1);
  EXPECT_LT(joints_[Insertion], 0.101);
  EXPECT_GT(outside(), 0);
}

// The tip is bent while the wall stops the insertion: it slides along, and away from the wall.
TEST_F(StuckTool, SlidesAlongTheWall) {
  auto command = joints_;
  for (int k = 0; k < 30; ++k) {
    command[Insertion] = joints_[Insertion] + 5e-3;
    command[TipLeftRight] += 5e-3;
    moveTo(command);
    ASSERT_DOUBLE_EQ(joints_[TipLeftRight], command[TipLeftRight]) << "step " << k;
    ASSERT_GT(outside(), 0) << "step " << k;
  }
  EXPECT_GT(joints_[Insertion], 0.1) << "the bent tip leaves room";
}

// However fast the tool comes, a part of the thickness stays between shape and mid-surface.
TEST(ToolGuard, KeepsAPartOfTheThickness) {
  constexpr double kRadius = 0.5e-3, kGap = 3e-3;
  const Isometry3d base = Isometry3d::Identity();
  SheetScene scene(kRadius, 6);
  for (const double thickness : {1e-3, 4e-3, 16e-3}) {
    ToolGuard guard(scene.tool, scene.mesh, std::vector<double>(scene.mesh.vertices.size(), thickness), scene.none);
    double least = kGap;
    for (const double way : {2.5e-3, 3e-3, 5e-3, 20e-3, 100e-3}) {
      std::array<double, kJointCount> from{0.1}, to{0.1 + way};
      ToolMotion motion(scene.tool, base, from, to);
      ToolPoses poses;
      motion.linkPoses(0, poses.start);
      motion.linkPoses(1, poses.end);
      const Vector3d front = poses.start[scene.tool.linkIndex("scope_tip")] * scene.front;
      Points wall = scene.start;
      for (std::size_t k = 0; k < 3; ++k)
        for (double& x : wall[k]) x += front[static_cast<int>(k)] + (k == 0 ? kGap : 0);
      EXPECT_EQ(guard.separate(poses, motion, pathOf(wall, wall), {}), 1);
      const double left = kGap - (motion.inputs(1)[Insertion] - 0.1);
      EXPECT_GE(left, stepPolicy().guard_kept * thickness - 1e-8) << way;
      least = std::min(least, left);
    }
    EXPECT_LT(least, stepPolicy().guard_kept * thickness + 0.2 * kGap) << "it comes near";
  }
}

TEST(ToolGuard, SaysWhatStopsTheTool) {
  const Isometry3d base = Isometry3d::Identity();
  SheetScene scene(0.5e-3, 6);
  ToolGuard guard(scene.tool, scene.mesh, scene.thickness, scene.none);
  const auto movedBy = [&](double way) { return ToolMotion(scene.tool, base, {0.1}, {0.1 + way}); };
  ToolMotion ahead = movedBy(5e-3), back = movedBy(-5e-3);
  ToolPoses poses;
  ahead.linkPoses(0, poses.start);
  const Vector3d front = poses.start[scene.tool.linkIndex("scope_tip")] * scene.front;
  Points wall = scene.start;
  for (std::size_t k = 0; k < 3; ++k)
    for (double& x : wall[k]) x += front[static_cast<int>(k)] + (k == 0 ? 1e-3 : 0);
  EXPECT_TRUE(guard.meets(poses, back, pathOf(wall, wall), {}).empty());
  EXPECT_FALSE(guard.stop(poses, back, pathOf(wall, wall), {}));
  EXPECT_EQ(guard.blockingVertex(), -1);
  const std::vector<int> met = guard.meets(poses, ahead, pathOf(wall, wall), {});
  ASSERT_GE(met.size(), 3u);
  EXPECT_TRUE(std::is_sorted(met.begin(), met.end()));
  EXPECT_TRUE(guard.stop(poses, ahead, pathOf(wall, wall), {}));
  EXPECT_TRUE(std::binary_search(met.begin(), met.end(), guard.blockingVertex()));
  EXPECT_LT(ahead.inputs(1)[Insertion], 0.101);
  const Vector3d blocking =
      Vector3d(wall[0][guard.blockingVertex()], wall[1][guard.blockingVertex()], wall[2][guard.blockingVertex()]);
  EXPECT_LT((blocking - front).norm(), 0.01) << "a vertex of a triangle before the tool";
}

}  // namespace
}  // namespace vibe::tool_guard_test
