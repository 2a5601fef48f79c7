// Which pairs of tool and wall are looked at, and which of them need no approach.
#include "tool_contact/near_triangles.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "self_contact/self_contact_worlds.hpp"
#include "vibe_testing/scope_fixture.hpp"

namespace vibe::near_triangles_test {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using Points = std::array<std::vector<double>, 3>;
using Pairs = std::vector<NearTriangles::Pair>;

SurfacePath pathOf(const Points& from, const Points& to) {
  return {{from[0].data(), from[1].data(), from[2].data()}, {to[0].data(), to[1].data(), to[2].data()}};
}

bool operator==(const Pairs& one, const Pairs& other) {
  return std::equal(one.begin(), one.end(), other.begin(), other.end(),
                    [](const auto& a, const auto& b) { return a.shape == b.shape && a.triangle == b.triangle; });
}

/// A tool that is moved about in a sphere whose wall is moved about.
class World {
 public:
  World()
      : mesh(test::sphere(0.03, 9)),
        tool(ToolModel::fromUrdf(scopeText(), "scope")),
        swept(tool),
        passable(mesh.vertices.size(), 0) {
    for (std::size_t k = 0; k < 3; ++k)
      for (const Vector3d& p : mesh.vertices) wall[k].push_back(p[static_cast<Eigen::Index>(k)]);
    poses.assign(static_cast<std::size_t>(tool.linkCount()), Isometry3d::Identity());
    for (std::size_t i = 0; i < poses.size(); ++i)
      poses[i].translation() = Vector3d(0.02 * random(), 0.02 * random(), 0.02 * random());
  }

  /// @param size  of the motions [m]
  void move(double size) {
    before = wall, poses_before = poses;
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
      for (std::vector<double>& component : wall) component[i] += size * random();
    for (Isometry3d& pose : poses) {
      pose.rotate(Eigen::AngleAxisd(20 * size * random(), Vector3d(random(), random(), random()).normalized()));
      pose.pretranslate(Vector3d(size * random(), size * random(), size * random()));
    }
    swept.place(poses_before, poses);
  }

  SurfacePath path() const { return pathOf(before, wall); }
  double random() { return std::uniform_real_distribution<double>(-1, 1)(engine); }

  SurfaceMesh mesh;
  ToolModel tool;
  SweptTool swept;
  std::vector<char> passable;
  Points wall, before;
  std::vector<Isometry3d> poses, poses_before;
  std::mt19937 engine{7};
};

TEST(NearTriangles, AKeptListFindsWhatANewOneFinds) {
  World world;
  NearTriangles kept(world.mesh, world.passable);
  Pairs found, expected;
  constexpr int kSteps = 200;
  std::size_t most = 0;
  for (int step = 0; step < kSteps; ++step) {
    world.move(step % 20 == 19 ? 3e-3 : 5e-5);
    const double reach = step % 3 == 0 ? 1e-4 : 2e-3;
    kept.find(world.swept, world.path(), reach, found);
    NearTriangles(world.mesh, world.passable).find(world.swept, world.path(), reach, expected);
    ASSERT_TRUE(found == expected) << step;
    most = std::max(most, found.size());
  }
  EXPECT_GT(most, 50u);
  EXPECT_LT(kept.listings(), kSteps / 4);
}

TEST(NearTriangles, FindsAllThatComeNear) {
  World world;
  const double reach = 1e-3;
  NearTriangles near(world.mesh, world.passable);
  Pairs found;
  int met = 0;
  for (int step = 0; step < 5; ++step) {
    world.move(1e-3);
    const SurfacePath path = world.path();
    near.find(world.swept, path, reach, found);
    for (int s = 0; s < world.swept.count(); ++s)
      for (int t = 0; t < static_cast<int>(near.triangles().size()); ++t) {
        const auto& n = near.triangles()[static_cast<std::size_t>(t)];
        bool comes_near = false;
        for (const double when : {0., 0.5, 1.})
          comes_near =
              comes_near ||
              world.swept.gap(s, when, {path.at(n[0], when), path.at(n[1], when), path.at(n[2], when)}).distance -
                      world.swept.radius(s) <
                  reach;
        if (!comes_near) continue;
        ++met;
        EXPECT_TRUE(std::any_of(found.begin(), found.end(),
                                [&](const auto& pair) { return pair.shape == s && pair.triangle == t; }));
      }
  }
  EXPECT_GT(met, 100);
}

TEST(NearTriangles, LeavesOutWhatIsNotFiniteAndRecovers) {
  World world;
  NearTriangles near(world.mesh, world.passable);
  Pairs before, found;
  world.move(1e-5);
  near.find(world.swept, world.path(), 2e-3, before);
  ASSERT_FALSE(before.empty());
  const int triangle = before.front().triangle, vertex = near.triangles()[static_cast<std::size_t>(triangle)][0];
  const double x = std::exchange(world.before[0][static_cast<std::size_t>(vertex)], NAN);
  near.find(world.swept, world.path(), 2e-3, found);
  EXPECT_LT(found.size(), before.size());
  for (const auto& pair : found) EXPECT_NE(pair.triangle, triangle);
  world.before[0][static_cast<std::size_t>(vertex)] = x;
  near.find(world.swept, world.path(), 2e-3, found);
  EXPECT_TRUE(found == before);
}

TEST(StaysApart, WhatADirectionSeparatesIsApproachedToTheEnd) {
  World world;
  int apart = 0, all = 0;
  for (int step = 0; step < 40; ++step) {
    world.move(step % 2 == 0 ? 1e-3 : 1e-4);
    const SurfacePath path = world.path();
    for (int s = 0; s < world.swept.count(); ++s)
      for (const auto& n : world.mesh.triangles) {
        if (!world.swept.hasSegment(s)) continue;
        const double floor = world.swept.radius(s) + 1e-4, least = floor + 5e-4 * (1 + world.random());
        ++all;
        if (!staysApart(world.swept, s, path, n, floor, least)) continue;
        ++apart;
        const ToolApproach approached = approach(world.swept, s, path, n, floor);
        ASSERT_EQ(approached.fraction, 1);
        ASSERT_GT(approached.nearest, least);
      }
  }
  EXPECT_GT(apart, all / 3);
}

}  // namespace
}  // namespace vibe::near_triangles_test
