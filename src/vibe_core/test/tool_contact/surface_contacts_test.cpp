// Contacts of a tool with the triangles of a wall, and the guard behind them.
#include "tool_contact/surface_contacts.hpp"

#include <gtest/gtest.h>

#include <map>
#include <numeric>
#include <random>

#include "tool_contact/thin_tool.hpp"
#include "tool_contact/tool_guard.hpp"
#include "vibe_testing/worlds.hpp"

namespace vibe::surface_contacts_test {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using Points = std::array<std::vector<double>, 3>;

constexpr double kThickness = 2e-3;
constexpr double kRounding = 1e-8;  // shapes are stored in single precision [m]

/// A square sheet of `cells` by `cells` pairs of triangles around the origin, in the plane x = 0.
SurfaceMesh sheet(double size, int cells) {
  SurfaceMesh mesh;
  for (int i = 0; i <= cells; ++i)
    for (int j = 0; j <= cells; ++j)
      mesh.vertices.emplace_back(0, size * (static_cast<double>(i) / cells - 0.5),
                                 size * (static_cast<double>(j) / cells - 0.5));
  const auto at = [cells](int i, int j) { return i * (cells + 1) + j; };
  for (int i = 0; i < cells; ++i)
    for (int j = 0; j < cells; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return mesh;
}

Points pointsOf(const SurfaceMesh& mesh) {
  Points points;
  for (const Vector3d& p : mesh.vertices)
    for (int k = 0; k < 3; ++k) points[static_cast<std::size_t>(k)].push_back(p[k]);
  return points;
}

SurfacePath pathOf(const Points& from, const Points& to) {
  return {{from[0].data(), from[1].data(), from[2].data()}, {to[0].data(), to[1].data(), to[2].data()}};
}

/// A thin tool before a sheet at rest: the capsule's front is `gap` before the sheet at `place` (y, z).
struct Scene {
  explicit Scene(double radius, int cells = 6, double length = 0.01)
      : tool(ToolModel::fromUrdf(test::thinToolText(radius, length, 10), "thin")),
        mesh(sheet(0.03, cells)),
        start(pointsOf(mesh)),
        thickness(mesh.vertices.size(), kThickness),
        none(mesh.vertices.size(), 0),
        contacts(tool, mesh, thickness, none) {
    front = tool_front(length, radius);
  }
  /// Link poses that put the front of the capsule at a place, pointing along x.
  std::vector<Isometry3d> posesAt(const Vector3d& place, const Eigen::Matrix3d& turn = Eigen::Matrix3d::Identity()) {
    std::vector<Isometry3d> poses(static_cast<std::size_t>(tool.linkCount()), Isometry3d::Identity());
    for (Isometry3d& pose : poses) {
      pose.linear() = turn;
      pose.translation() = place - turn * front;
    }
    return poses;
  }
  static Vector3d tool_front(double length, double radius) { return {length + radius, 0, 0}; }

  ToolModel tool;
  SurfaceMesh mesh;
  Points start;
  std::vector<double> thickness;
  std::vector<char> none;
  SurfaceContacts contacts;
  Vector3d front;
};

TEST(SurfaceContacts, AWideShapeHasOneContactPerVertexInReach) {
  Scene scene(8e-3, 10);  // 3 mm between vertices
  const auto poses = scene.posesAt({-1e-3, 0, 0});
  const auto& found = scene.contacts.find(poses, poses, pathOf(scene.start, scene.start), 0.5e-3, scene.none);
  ASSERT_GT(found.size(), 4u);
  for (const SurfaceContact& contact : found) {
    EXPECT_EQ(contact.point.count, 1);
    const Vector3d p = scene.mesh.vertices[contact.point.node[0]];
    const Vector3d centre(-9e-3, 0, 0);
    EXPECT_NEAR(contact.distance, (p - centre).norm() - 8e-3, kRounding);
    EXPECT_LT((contact.normal - (p - centre).normalized()).norm(), 1e-7);
    EXPECT_LT((contact.tool_point - (centre + 8e-3 * contact.normal)).norm(), kRounding);
    EXPECT_NEAR(contact.clearance, kThickness / 2, 1e-15);
  }
  // each vertex within reach is there once
  std::size_t expected = 0;
  for (const Vector3d& p : scene.mesh.vertices)
    expected += (p - Vector3d(-9e-3, 0, 0)).norm() < 8e-3 + kThickness / 2 + 0.5e-3 ? 1 : 0;
  EXPECT_EQ(found.size(), expected);
}

/// Of a point from the core of the capsule, in the frame of the pose.
Vector3d fromCore(const Isometry3d& pose, double length, const Vector3d& point) {
  const Vector3d local = pose.inverse() * point;
  return local - Vector3d(std::clamp(local.x(), 0.0, length), 0, 0);
}

// The row of a contact lacks what the distance lacks at the end of the step. With the normal of the middle of the step
// a point that keeps its distance does no work. Exact on sphere, cylinder and, with a radius far beyond the way, plane.
TEST(SurfaceContacts, AMotionAlongTheShapeDoesNoWorkWithTheNormalOfTheMiddle) {
  std::mt19937 random(13);
  std::uniform_real_distribution<double> c(-1, 1);
  constexpr double kLength = 0.01;
  for (const double radius : {3e-3, 8e-3, 0.5}) {
    Scene scene(radius, 15, kLength);
    const int tip = scene.tool.linkIndex("scope_tip");
    double tangent = 0;  // most that the normal at the end alone would be wrong by
    int checked = 0;
    for (int trial = 0; trial < 60; ++trial) {
      Eigen::Matrix3d lie = Eigen::AngleAxisd(0.25 * M_PI * (1 + c(random)), Vector3d::UnitZ()).toRotationMatrix();
      const Eigen::Matrix3d turn =
          Eigen::AngleAxisd(0.02 * c(random), Vector3d(c(random), c(random), 1).normalized()) * lie;
      auto start = scene.posesAt({0, 0, 0}, lie), end = start;
      double nearest = 1;  // of the sheet
      for (const Vector3d& p : scene.mesh.vertices) nearest = std::min(nearest, fromCore(start[0], kLength, p).norm());
      for (std::size_t k = 0; k < start.size(); ++k) {
        start[k].translation().x() -= radius + 0.9e-3 - nearest;
        end[k] = start[k];
        end[k].linear() = turn;
        end[k].translation() += 0.5e-3 * Vector3d(0.05 * c(random), c(random), c(random));
      }
      Points to = scene.start;
      for (auto& x : to)
        for (double& value : x) value += 0.05e-3 * c(random);
      const SurfacePath path = pathOf(scene.start, to);
      for (const SurfaceContact& contact : scene.contacts.find(start, end, path, 1e-3, scene.none, 0.5)) {
        if (contact.point.count != 1) continue;
        const int i = contact.point.node[0];
        const Vector3d p(to[0][i], to[1][i], to[2][i]);
        const Vector3d v = turn * fromCore(start[tip], kLength, scene.mesh.vertices[i]),
                       w = turn * fromCore(end[tip], kLength, p);
        const Vector3d slid = p - end[tip] * (start[tip].inverse() * scene.mesh.vertices[i]);
        if (w.norm() > radius + contact.clearance + 1e-3) continue;  // it leaves
        if (std::abs((w - v - slid).dot(v + w)) > 1e-12) continue;   // from one part of the capsule to another
        ++checked;
        const double scale = (v.norm() + w.norm()) / (v + w).norm();
        EXPECT_NEAR(contact.normal.dot(slid), scale * (w.norm() - v.norm()), kRounding);
        EXPECT_NEAR(contact.normal.dot(p - contact.tool_point), w.norm() - radius, kRounding);
        tangent = std::max(tangent, w.normalized().dot(slid) - (w.norm() - v.norm()));
      }
    }
    EXPECT_GT(checked, 100) << radius;
    if (radius < 0.1) {
      EXPECT_GT(tangent, 1e-6) << "with the normal at the end the shape would do work";
    }
  }
}

Points stretched(const Points& points, double stretch) {
  Points wider = points;
  for (auto& x : wider)
    for (double& value : x) value *= stretch;
  return wider;
}

// Contacts that all touch leave no room for the shape to come to the mid-surface, wherever it is.
TEST(SurfaceContacts, BetweenVerticesThereAreEnoughForAThinShape) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-5e-3, 5e-3);
  for (const double radius : {0.2e-3, 0.5e-3, 2e-3, 8e-3})
    for (const double stretch : {1.0, 1.2, 1.4, 2.0, 2.7}) {
      Scene scene(radius, 6);  // 5 mm between vertices at rest
      const Points at_present = stretched(scene.start, stretch);
      for (int trial = 0; trial < 200; ++trial) {
        const Vector3d at(-0.2 * kThickness, place(random), place(random));
        const auto poses = scene.posesAt(at);
        const auto& found = scene.contacts.find(poses, poses, pathOf(at_present, at_present), 0, scene.none);
        ASSERT_FALSE(found.empty()) << "a fifth of the wall from the mid-surface at " << at.transpose();
        for (const SurfaceContact& contact : found) EXPECT_LT(contact.distance, kThickness / 2 + 1e-12);
      }
    }
}

using Place = std::pair<std::array<int, 3>, std::array<double, 3>>;  // nodes, weights

/// How deep the middles of the short edges, which need no point at rest, are in what keeps them off [m].
std::map<Place, double> depths(Scene& scene, double stretch) {
  const auto poses = scene.posesAt({-0.1 * kThickness, 2.3e-3, 0.4e-3});
  const Points wall = stretched(scene.start, stretch);
  std::map<Place, double> depth;
  for (const SurfaceContact& contact : scene.contacts.find(poses, poses, pathOf(wall, wall), 0, scene.none)) {
    const auto& [a, b, none] = contact.point.node;
    if (contact.point.count == 2 && (scene.mesh.vertices[a] - scene.mesh.vertices[b]).norm() < 5.1e-3)
      depth[{contact.point.node, contact.point.weight}] = contact.clearance - contact.distance;
  }
  return depth;
}

// Otherwise a pressed wall never rests: a point that comes takes the load from the vertices, the edge becomes shorter
// without it, and it goes again.
TEST(SurfaceContacts, TheMiddleOfAStretchedEdgeComesAndGoesWithoutAJump) {
  constexpr double kFiner = 1.002, kMost = 2.4;
  constexpr double kJump = 0.1e-3;  // in one of these steps vertices move by a tenth of it [m]
  Scene scene(8e-3, 6);             // 5 mm between vertices at rest
  std::map<Place, double> before = depths(scene, 1);
  EXPECT_TRUE(before.empty());
  std::size_t most = 0;
  for (double stretch = kFiner; stretch < kMost; stretch *= kFiner) {
    const std::map<Place, double> now = depths(scene, stretch);
    for (const auto& [place, depth] : now)
      EXPECT_NEAR(depth, before.count(place) != 0 ? before.at(place) : 0, kJump) << stretch;
    for (const auto& [place, depth] : before)
      if (now.count(place) == 0) {
        EXPECT_LT(depth, kJump) << stretch;
      }
    most = std::max(most, now.size());
    before = now;
  }
  EXPECT_GT(most, 0u);
}

TEST(SurfaceContacts, ANormalKeepsItsSideHoweverFastTheToolIs) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-5e-3, 5e-3), angle(-1, 1), speed(0, 0.3);
  Scene scene(0.4e-3, 6);
  for (int trial = 0; trial < 500; ++trial) {
    const Eigen::Matrix3d turn =
        (Eigen::AngleAxisd(angle(random), Vector3d::UnitY()) * Eigen::AngleAxisd(angle(random), Vector3d::UnitZ()))
            .toRotationMatrix();
    const Vector3d before(-1.2e-3, place(random), place(random));
    const auto start = scene.posesAt(before, turn);
    const auto end = scene.posesAt(before + Vector3d(speed(random), 0, 0), turn);
    const auto& found = scene.contacts.find(start, end, pathOf(scene.start, scene.start), 2e-3, scene.none);
    ASSERT_FALSE(found.empty());
    bool forward = false;
    for (const SurfaceContact& contact : found) {
      EXPECT_GT(contact.normal.x(), -1e-9) << "trial " << trial;
      forward = forward || contact.normal.x() > 0.3;
    }
    EXPECT_TRUE(forward) << "the wall is pushed on";
  }
}

TEST(SurfaceContacts, WhatIsPassableOrExcludedHasNone) {
  Scene scene(2e-3);
  const std::vector<char> all(scene.none.size(), 1);
  SurfaceContacts open(scene.tool, scene.mesh, scene.thickness, all);
  const auto poses = scene.posesAt({0, 0, 0});
  const SurfacePath path = pathOf(scene.start, scene.start);
  EXPECT_TRUE(open.find(poses, poses, path, 1e-3, scene.none).empty());
  EXPECT_FALSE(scene.contacts.find(poses, poses, path, 1e-3, scene.none).empty());
  EXPECT_TRUE(scene.contacts.find(poses, poses, path, 1e-3, all).empty());
}

TEST(SegmentTriangleGap, IsTheNearestOfManySamples) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> c(-1, 1);
  const auto point = [&] { return Vector3d(c(random), c(random), c(random)); };
  for (int trial = 0; trial < 300; ++trial) {
    const Vector3d a = point(), b = point();
    std::array<Vector3d, 3> t{point(), point(), point()};
    if (trial % 3 == 0) t[1] = t[2] = t[0];  // a point
    const TriangleGap gap = segmentTriangleGap(a, b, t);
    double nearest = 10;
    constexpr int kCuts = 40;
    for (int i = 0; i <= kCuts; ++i)
      for (int u = 0; u <= kCuts; ++u)
        for (int v = 0; u + v <= kCuts; ++v) {
          const Vector3d p = a + (b - a) * i / kCuts;
          const Vector3d q = t[0] + (t[1] - t[0]) * u / kCuts + (t[2] - t[0]) * v / kCuts;
          nearest = std::min(nearest, (p - q).norm());
        }
    if (trial % 3 == 0) {
      const double s = std::clamp((t[0] - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
      EXPECT_NEAR(gap.distance, (t[0] - a - s * (b - a)).norm(), 1e-12);
    }
    EXPECT_LE(gap.distance, nearest + 1e-12);
    EXPECT_GT(gap.distance, nearest - 0.09);
    EXPECT_NEAR(gap.weight.sum(), 1, 1e-12);
    const Vector3d at = gap.weight[0] * t[0] + gap.weight[1] * t[1] + gap.weight[2] * t[2];
    EXPECT_LT((gap.core + gap.distance * gap.normal - at).norm(), 1e-9);
  }
}

// The guard alone, without contacts: wall and tool in random motion.
TEST(ToolGuard, NothingPassesWhateverMoves) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> c(-1, 1), fast(0, 0.2);
  Scene scene(0.3e-3, 6);
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
    const double free = guard.keepApart(poses, made, pathOf(wall, moved), {});
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
    const double free = guard_.keepApart(poses, motion, pathOf(wall_, pushed), held);
    joints_ = motion.inputs(1);
    for (double& x : wall_[0]) x -= free * push;
    return free;
  }
  double outside() {
    scene_.tool.forwardKinematics(joints_, poses_);
    return wall_[0][0] - (poses_[scene_.tool.linkIndex("scope_tip")] * scene_.front).x();
  }

  static constexpr double kRadius = 0.5e-3;
  Scene scene_;
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

TEST_F(StuckTool, GivesWayToAWallThatIsFaster) {
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

}  // namespace
}  // namespace vibe::surface_contacts_test
