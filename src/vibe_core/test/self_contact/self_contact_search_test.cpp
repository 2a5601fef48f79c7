#include "self_contact/self_contact.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "geometry/triangle_distance.hpp"
#include "self_contact/self_contact_search.hpp"
#include "self_contact/self_contact_worlds.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::self_contact_search_test {
namespace {

using namespace test;

TEST(SelfContactSearch, SphereMeetsItselfOnlyWhenFlattened) {
  ContactWorld world(sphere(0.05, 19));
  ASSERT_EQ(world.count(), 3612U);
  for (const double scale : {1.0, 2.0}) {
    for (std::size_t i = 0; i < world.count(); ++i) world.set(i, scale * world.rest.vertices[i]);
    world.detect(2e-3);
    EXPECT_TRUE(world.contact.pairs().empty()) << scale;
    EXPECT_EQ(world.evaluate(), 0);
  }
  for (std::size_t i = 0; i < world.count(); ++i) {
    Eigen::Vector3d p = world.rest.vertices[i];
    p.z() *= 0.04;
    world.set(i, p);
  }
  world.detect(2e-3);
  EXPECT_GT(world.contact.pairs().size(), 1000U);
  EXPECT_GT(world.evaluate(), 0);
}

TEST(SelfContactSearch, NeighboursAlongTheSurfaceNeverCount) {
  ContactWorld world(sphere(0.05, 12));
  for (std::size_t i = 0; i < world.count(); ++i) world.set(i, 0.1 * world.rest.vertices[i]);
  world.shake(2e-3, 9);
  world.detect(2e-3);
  ASSERT_GT(world.contact.pairs().size(), 500U);
  double min = 1;
  for (const auto& pair : world.contact.pairs())
    for (std::size_t k = 0; k < 4; ++k)
      for (std::size_t l = 0; l < 4; ++l)
        if (pair.weight[k] > 0 && pair.weight[l] < 0)  // of the two points
          min = std::min(min, (world.rest.vertices[pair.node[k]] - world.rest.vertices[pair.node[l]]).norm());
  EXPECT_GT(min, 2 * kWallThickness);
}

TEST(SelfContactSearch, ResultDoesNotDependOnHistory) {
  PressedPlates fresh;
  ContactWorld old(plates(8, 6));
  for (const double gap : {0.05, 0.01, 4e-3, 3e-3, -1e-3}) {
    old.bring(plateSize(8), gap);
    old.detect(gap > 5e-3 ? 2e-3 : 0.5e-3);
  }
  old.at = fresh.at;
  old.detect(1e-3);
  ASSERT_EQ(old.contact.pairs().size(), fresh.contact.pairs().size());
  EXPECT_EQ(old.evaluate(), fresh.evaluate());
  EXPECT_EQ(old.gradient, fresh.gradient);
}

/// A sphere that is flattened while a part of it is pushed about fast, and all of it shaken.
std::vector<double> pushAbout(const ContactWorld& world, int step, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<double> move(world.at.size(), 0.0);
  const Eigen::Vector3d push(3e-3 * std::sin(0.7 * step), 2e-3 * std::cos(0.4 * step), step % 9 < 5 ? -4e-3 : 5e-3);
  for (std::size_t i = 0; i < world.count(); ++i) {
    const Eigen::Vector3d p = world.get(i), at_rest = world.rest.vertices[i];
    const double near = std::exp(-(at_rest - Eigen::Vector3d(0, 0, 0.03)).squaredNorm() / 1e-4);
    for (int k = 0; k < 3; ++k) move[4 * i + k] = near * push[k] + 0.05e-3 * uniform(random);
    move[4 * i + 2] -= step < 20 ? 0.1 * p.z() : 0.01 * p.z();
  }
  return move;
}

TEST(SelfContactSearch, RenewsAllThatMatters) {
  ContactWorld old(sphere(0.03, 9));
  std::mt19937 random(5);
  std::size_t pairs = 0, stopped = 0;
  for (int step = 0; step < 40; ++step) {
    ContactWorld fresh(old.rest);
    fresh.at = old.at;
    const double reach = step % 7 == 3 ? 2e-3 : 0.5e-3;
    old.detect(reach);
    fresh.detect(reach);
    ASSERT_EQ(old.contact.pairs().size(), fresh.contact.pairs().size()) << step;
    ASSERT_EQ(old.evaluate(), fresh.evaluate()) << step;
    ASSERT_EQ(old.gradient, fresh.gradient) << step;
    pairs = std::max(pairs, old.contact.pairs().size());
    const std::vector<double> move = pushAbout(old, step, random);
    stopped += old.resolvePenetrations(move);
    fresh.resolvePenetrations(move);
    ASSERT_EQ(old.at, fresh.at) << step;
    ASSERT_EQ(old.crossings(), 0U) << step;
  }
  EXPECT_GT(pairs, 100U);
  EXPECT_GT(stopped, 50U);
}

// Without leaving the places for which the lists hold.
TEST(SelfContactSearch, FindsWallsThatTurnToEachOther) {
  ContactWorld old(plates(8, 2, 0.75e-3)), fresh(old.rest);
  const auto tilt = [](ContactWorld& world, double between_normals) {
    const Eigen::AngleAxisd turn(M_PI - between_normals, Eigen::Vector3d::UnitX());
    for (std::size_t i = plateSize(8); i < world.count(); ++i) {
      const Eigen::Vector3d& at_rest = world.rest.vertices[i];
      world.set(i, turn * Eigen::Vector3d(at_rest.x(), at_rest.y(), 0) + Eigen::Vector3d(0, 0, 2e-3));
    }
    world.detect(0.5e-3);
  };
  tilt(old, 0.8);
  EXPECT_TRUE(old.contact.pairs().empty());
  tilt(old, 1.5);
  tilt(fresh, 1.5);
  EXPECT_GT(fresh.contact.pairs().size(), 0U);
  ASSERT_EQ(old.contact.pairs().size(), fresh.contact.pairs().size());
  EXPECT_EQ(old.evaluate(), fresh.evaluate());
}

/// What SelfContactSearch::near() promises, pair by pair.
class NearByForce {
 public:
  NearByForce(const SurfaceMesh& mesh, const SurfaceWalls& walls, double cosine, const std::vector<double>& at)
      : mesh_(mesh), walls_(walls), cosine_(cosine), normals_(mesh.vertices.size()) {
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) at_.push_back({at[4 * v], at[4 * v + 1], at[4 * v + 2]});
    for (const auto& n : mesh.triangles) {
      const Eigen::Vector3d normal = (at_[n[1]] - at_[n[0]]).cross(at_[n[2]] - at_[n[0]]).normalized();
      normal_.push_back(normal);
      for (const int v : n) normals_[v].push_back(normal);
    }
  }
  bool has(int v, int t, double distance) const {
    const auto& n = mesh_.triangles[t];
    if ((at_[v] - at_[n[0]]).norm() > distance + 0.03) return false;
    if (walls_.oneWall(v, n[0]) || walls_.oneWall(v, n[1]) || walls_.oneWall(v, n[2])) return false;
    const auto faces = [&](const Eigen::Vector3d& normal) { return normal.dot(normal_[t]) < cosine_; };
    return std::any_of(normals_[v].begin(), normals_[v].end(), faces) &&
           triangleFoot(at_[v], at_[n[0]], at_[n[1]], at_[n[2]]).away.norm() < distance;
  }

 private:
  const SurfaceMesh& mesh_;
  const SurfaceWalls& walls_;
  double cosine_;
  std::vector<Eigen::Vector3d> at_, normal_;
  std::vector<std::vector<Eigen::Vector3d>> normals_;  // of the triangles at each vertex
};

TEST(SelfContactSearch, ListsAllThatIsNear) {
  constexpr double kCosine = 0.3, kDistance = 4e-3;
  ContactWorld world(sphere(0.03, 9));
  const SurfaceWalls walls(world.rest, 1.6 * kWallThickness);
  SelfContactSearch search(world.rest, {walls, kCosine, 0.1 * kWallThickness, 0.5 * kWallThickness});
  std::mt19937 random(6);
  const auto columns = [&](const std::vector<double>& at) {
    std::array<std::vector<double>, 3> x;
    for (std::size_t i = 0; i < at.size(); ++i)
      if (i % 4 < 3) x[i % 4].push_back(at[i]);
    return x;
  };
  int missed = 0, expected = 0;
  for (int step = 0; step < 30; ++step) {
    const auto from = columns(world.at);
    const std::vector<double> move = pushAbout(world, step, random);
    for (std::size_t i = 0; i < move.size(); ++i) world.at[i] += move[i];
    const auto to = columns(world.at);
    ASSERT_TRUE(search.adapt({from[0].data(), from[1].data(), from[2].data()},
                             {to[0].data(), to[1].data(), to[2].data()}, kDistance));
    const NearByForce near(world.rest, walls, kCosine, world.at);
    for (int v = 0; v < static_cast<int>(world.count()); ++v)
      for (int t = 0; t < static_cast<int>(world.rest.triangles.size()); ++t) {
        if (!near.has(v, t, kDistance)) continue;
        ++expected;
        const SelfContactSearch::Near pair{v, t, 0};
        missed += std::binary_search(search.near().begin(), search.near().end(), pair) ? 0 : 1;
      }
  }
  EXPECT_GT(expected, 10000);
  EXPECT_EQ(missed, 0);
}

TEST(SelfContactSearch, SearchesOnlyWhenSomethingCanHaveComeNear) {
  ContactWorld world(plates(8, 6));
  world.detect(1e-3);
  world.detect(1e-3);
  EXPECT_EQ(world.contact.searchCount(), 1);
  double gap = 0.1;
  while (world.contact.pairs().empty() && gap > 0) {  // the approach is not missed in spite of the skipped searches
    gap -= 0.1e-3;
    world.bring(plateSize(8), gap, {0, 0});
    world.detect(1e-3);
  }
  EXPECT_NEAR(gap, 1.25 * kWallThickness + 1e-3, 0.11e-3);
  EXPECT_LT(world.contact.searchCount(), 320);
}

TEST(SelfContactSearch, PositionsThatAreNotFiniteMeetNothing) {
  PressedPlates world;
  world.at[4] = std::numeric_limits<double>::quiet_NaN();
  world.detect(1e-3);
  EXPECT_TRUE(world.contact.pairs().empty());
  world.at[4] = 0;
  world.detect(1e-3);
  EXPECT_FALSE(world.contact.pairs().empty());
}

TEST(SelfContactSearch, RejectsWhatItCannotUse) {
  const SurfaceMesh mesh = plates(2, 2);
  std::vector<double> thickness(mesh.vertices.size(), kWallThickness);
  EXPECT_NO_THROW(SelfContact(mesh, thickness, kModulus));
  EXPECT_THROW(SelfContact(mesh, thickness, 0), Error);
  thickness[3] = 0;
  EXPECT_THROW(SelfContact(mesh, thickness, kModulus), Error);
  thickness.pop_back();
  EXPECT_THROW(SelfContact(mesh, thickness, kModulus), Error);
  SurfaceMesh broken = mesh;
  broken.triangles[1][2] = 99;
  EXPECT_THROW(SelfContact(broken, std::vector<double>(mesh.vertices.size(), kWallThickness), kModulus), Error);
}

// 200 steps in which the nodes of a sphere move to and fro by `moved`; how often a search was needed.
long searches(double moved) {
  ContactWorld world(sphere(0.05, 19));
  for (int i = 0; i < 200; ++i) {
    world.detect(2e-3);
    for (std::size_t node = 0; node < world.count(); ++node) world.at[4 * node] += i % 2 == 0 ? moved : -moved;
  }
  return world.contact.searchCount();
}

TEST(SelfContactSearch, IsDueOnlyAfterMotion) {  // what it costs is a matter of benchmarks
  EXPECT_EQ(searches(1e-7), 1);
  EXPECT_GT(searches(5e-3), 100);
}

}  // namespace
}  // namespace vibe::self_contact_search_test
