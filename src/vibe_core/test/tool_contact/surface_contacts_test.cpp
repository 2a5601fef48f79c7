// Contacts of a tool with the triangles of a wall.
#include "tool_contact/surface_contacts.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>
#include <utility>

#include "tool_contact/sheet_scene.hpp"
#include "vibe_testing/worlds.hpp"

namespace vibe::surface_contacts_test {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using namespace test::sheet;

constexpr double kRounding = 1e-8;  // shapes are stored in single precision [m]

TEST(SurfaceContacts, AWideShapeHasOneContactPerVertexInReach) {
  SheetScene scene(8e-3, 10);  // 3 mm between vertices
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
    SheetScene scene(radius, 15, kLength);
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
      SheetScene scene(radius, 6);  // 5 mm between vertices at rest
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

/// How deep the points that divide edges and triangles are in what keeps them off [m].
std::map<Place, double> depths(SheetScene& scene, SurfaceContacts& contacts, double stretch) {
  const auto poses = scene.posesAt({-0.1 * kThickness, 2.3e-3, 0.4e-3});
  const Points wall = stretched(scene.start, stretch);
  std::map<Place, double> depth;
  for (const SurfaceContact& contact : contacts.find(poses, poses, pathOf(wall, wall), 0, scene.none))
    if (contact.point.count > 1)
      depth[{contact.point.node, contact.point.weight}] = contact.clearance - contact.distance;
  return depth;
}

double depthAt(const Place& place, const std::map<Place, double>& depths) {
  const auto found = depths.find(place);
  return found == depths.end() ? 0 : found->second;
}

/// Into how many parts edges are divided.
int mostParts(const std::map<Place, double>& depths) {
  int most = 1;
  for (const auto& [place, depth] : depths)
    if (place.first[2] < 0) most = std::max(most, static_cast<int>(std::lround(1 / place.second[1])));
  return most;
}

/// By how much the depth of a point changes while a wall is stretched by 0.2 % after the other, where vertices move by
/// 10 um each time [m].
/// @param thin   thickness of half of the wall, ratio to the other half
/// @param parts  out: into which edges are divided at most
double largestJump(double radius, double thin, int& parts) {
  constexpr double kFiner = 1.002, kMost = 4.2;
  SheetScene scene(radius, 6);  // 5 mm between vertices at rest
  for (std::size_t v = 0; v < scene.thickness.size() / 2; ++v) scene.thickness[v] *= thin;
  SurfaceContacts contacts(scene.tool, scene.mesh, scene.thickness, scene.none);
  std::map<Place, double> before = depths(scene, contacts, 1);
  double jump = 0;
  for (double stretch = kFiner; stretch < kMost; stretch *= kFiner) {
    const std::map<Place, double> now = depths(scene, contacts, stretch);
    for (const auto& [place, depth] : now) jump = std::max(jump, depth - depthAt(place, before));
    for (const auto& [place, depth] : before) jump = std::max(jump, depth - depthAt(place, now));
    parts = std::max(parts, mostParts(now));
    before = now;
  }
  return jump;
}

// Otherwise a pressed wall never rests: a point that comes takes the load from its neighbours, the edge becomes shorter
// without it, and it goes again. The shapes need no points at rest, one on each edge, and more.
TEST(SurfaceContacts, PointsOfAStretchedWallComeAndGoWithoutAJump) {
  constexpr double kJump = 0.1e-3;  // [m]
  int parts = 0, ignored = 0;
  for (const double radius : {8e-3, 2e-3, 0.8e-3})
    for (const double thin : {1.0, 0.6}) EXPECT_LT(largestJump(radius, thin, parts), kJump) << radius << ", " << thin;
  EXPECT_GT(parts, 4) << "edges are halved twice";
  StepPolicy at_once = stepPolicy();
  at_once.touch_fade_in = 1e-3;
  const ScopedStepPolicy scoped(at_once);
  EXPECT_GT(largestJump(8e-3, 1, ignored), 2 * kJump) << "what this guards against is seen";
}

/// Shapes with which a wall has contacts where two shapes that share an end meet at an angle.
/// @param side  1, -1: towards one of them by so much that its foot on the other is in the first; 0: it touches both
/// @param outside  of the bend; otherwise in its inner corner
std::set<int> shapesAtBend(const ToolModel& tool, const std::vector<Isometry3d>& poses, int one, int other,
                           const Vector3d& joint, double side, bool outside = false) {
  SweptTool at(tool);
  at.place(poses, poses);
  const auto away = [&](int shape) {
    const auto [a, b] = at.segment(shape, 1);
    return ((a - joint).norm() > (b - joint).norm() ? a - joint : b - joint).normalized().eval();
  };
  const Vector3d a = away(one), b = away(other), inner = (a + b).normalized(), along = (b - a).normalized();
  const double touching = at.radius(one) + kThickness / 2,
               from_joint = outside ? -touching : touching / inner.cross(a).norm();
  const double aside = side * (kThickness / 2 * inner.dot(a) / inner.cross(a).norm() + 50e-6);
  const Vector3d p = joint + from_joint * inner + aside * along, across = 6e-3 * a.cross(b).normalized();
  SurfaceMesh mesh;
  const Vector3d away_from_tool = (outside ? -3e-3 : 3e-3) * inner;
  mesh.vertices = {p, p + across + away_from_tool, p - across + away_from_tool};
  mesh.triangles = {{0, 1, 2}};
  const Points wall = pointsOf(mesh);
  SurfaceContacts contacts(tool, mesh, std::vector<double>(3, kThickness), std::vector<char>(3, 0));
  std::set<int> shapes;
  for (const SurfaceContact& contact : contacts.find(poses, poses, pathOf(wall, wall), 0.5e-3, std::vector<char>(3, 0)))
    if (contact.point.count == 1 && contact.point.node[0] == 0) shapes.insert(contact.shape);
  return shapes;
}

/// Calls back with every two shapes of a scope that share an end and meet at an angle.
template <class Take>
void forCorners(const ToolModel& tool, const std::vector<Isometry3d>& poses, Take take) {
  SweptTool at(tool);
  at.place(poses, poses);
  for (int one = 0; one < at.count(); ++one)
    for (int other = 0; other < at.count(); ++other) {
      if (one == other || !at.hasSegment(one) || !at.hasSegment(other)) continue;
      const auto a = at.segment(one, 1), b = at.segment(other, 1);
      const double sine = (a[1] - a[0]).normalized().cross((b[1] - b[0]).normalized()).norm();
      for (const Vector3d& end : a)
        if (((end - b[0]).norm() < 1e-6 || (end - b[1]).norm() < 1e-6) && sine > 0.03) take(one, other, end);
    }
}

/// The same for poses of a scope that is bent more and more.
template <class Take>
void forBends(const ToolModel& tool, Take take) {
  for (const double bend : {0.5, 1.0, 2.5}) {
    std::array<double, kJointCount> inputs{};
    inputs[TipUpDown] = bend;
    std::vector<Isometry3d> poses;
    tool.forwardKinematics(inputs, poses);
    SCOPED_TRACE("bent by " + std::to_string(bend));
    forCorners(tool, poses, [&](int one, int other, const Vector3d& joint) { take(poses, one, other, joint); });
  }
}

// Alone, the nearer one would push the wall to the other one, and then the other one back.
TEST(SurfaceContacts, InACornerBetweenShapesTheWallRestsAgainstBoth) {
  const ToolModel tool = ToolModel::fromUrdf(scopeText(), "scope");
  int corners = 0, one_only = 0;
  forBends(tool, [&](const std::vector<Isometry3d>& poses, int one, int other, const Vector3d& joint) {
    for (const double side : {-1.0, 0.0, 1.0}) {
      const auto shapes = [&] { return shapesAtBend(tool, poses, one, other, joint, side); };
      EXPECT_EQ(shapes().count(one), 1u) << "on side " << side;
      EXPECT_EQ(shapes().count(other), 1u);
      if (side == 0) continue;
      StepPolicy nearest_only = stepPolicy();
      nearest_only.touch_corner = 0;
      const ScopedStepPolicy scoped(nearest_only);
      one_only += shapes().count(one) + shapes().count(other) == 1 ? 1 : 0;
      ++corners;
    }
  });
  EXPECT_GT(corners, 20);
  EXPECT_EQ(one_only, corners) << "what this guards against is seen";
}

// Two would share the load like two springs, and one of them would come and go with its share.
TEST(SurfaceContacts, OnTheOutsideOfABendOneShapeHasTheContact) {
  const ToolModel tool = ToolModel::fromUrdf(scopeText(), "scope");
  int bends = 0;
  forBends(tool, [&](const std::vector<Isometry3d>& poses, int one, int other, const Vector3d& joint) {
    for (const double side : {-2.0, -1.0, 0.0, 1.0, 2.0}) {
      const std::set<int> shapes = shapesAtBend(tool, poses, one, other, joint, side, true);
      EXPECT_EQ(shapes.count(one) + shapes.count(other), 1u) << "on side " << side;
      ++bends;
    }
  });
  EXPECT_GT(bends, 20);
}

/// Largest distance by which a wall is farther from a shape that it has a contact with than from the nearest one, at
/// random places around a bent scope [m].
double farthestBeside(const ToolModel& tool, int& contacts_of_two) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> part(0, 1);
  double farthest = 0;
  forBends(tool, [&](const std::vector<Isometry3d>& poses, int, int, const Vector3d& joint) {
    for (int k = 0; k < 20; ++k) {
      const auto draw = [&] { return Vector3d(part(random) - 0.5, part(random) - 0.5, part(random) - 0.5); };
      SurfaceMesh mesh;
      mesh.vertices = {joint + 0.03 * draw(), joint + 0.03 * draw(), joint + 0.03 * draw()};
      mesh.triangles = {{0, 1, 2}};
      const Points wall = pointsOf(mesh);
      SurfaceContacts search(tool, mesh, std::vector<double>(3, kThickness), std::vector<char>(3, 0));
      std::map<std::array<double, 6>, std::vector<double>> gaps;
      for (const SurfaceContact& c : search.find(poses, poses, pathOf(wall, wall), 2e-3, std::vector<char>(3, 0)))
        gaps[{double(c.point.node[0]), double(c.point.node[1]), double(c.point.node[2]), c.point.weight[0],
              c.point.weight[1], c.point.weight[2]}]
            .push_back(c.distance - kThickness / 2);
      for (auto& [point, gap] : gaps) {
        std::sort(gap.begin(), gap.end());
        contacts_of_two += gap.size() > 1 ? 1 : 0;
        farthest = std::max(farthest, gap.back() - std::max(gap.front(), -3e-4));
      }
    }
  });
  return farthest;
}

// A step solves a limited number of contacts. Those that cannot touch would take the place of others, in turn.
TEST(SurfaceContacts, AShapeFarBesideTheNearestHasNone) {
  const ToolModel tool = ToolModel::fromUrdf(scopeText(), "scope");
  int contacts_of_two = 0;
  const double less_kept = stepPolicy().touch_corner_slack * stepPolicy().touch_corner;  // by contacts of corners
  EXPECT_LT(farthestBeside(tool, contacts_of_two), stepPolicy().touch_beside + less_kept + kRounding);
  EXPECT_GT(contacts_of_two, 20);
  StepPolicy all = stepPolicy();
  const double allowed = std::exchange(all.touch_beside, 1);
  const ScopedStepPolicy scoped(all);
  EXPECT_GT(farthestBeside(tool, contacts_of_two), 2 * allowed) << "what this guards against is seen";
}

TEST(SurfaceContacts, ANormalKeepsItsSideHoweverFastTheToolIs) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-5e-3, 5e-3), angle(-1, 1), speed(0, 0.3);
  SheetScene scene(0.4e-3, 6);
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
  SheetScene scene(2e-3);
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

}  // namespace
}  // namespace vibe::surface_contacts_test
