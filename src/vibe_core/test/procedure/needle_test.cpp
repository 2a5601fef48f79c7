// How deep the needle goes, where, and which particles the thread pulls on.
#include "procedure/needle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "procedure/procedure_bench.hpp"
#include "vibe_core/geometry/triangle_tree.hpp"

namespace vibe::needle_test {
namespace {

using test::Bench;
using test::icosphere;
using test::kBenchRadius;
using test::kBenchThickness;

struct Positions {
  explicit Positions(const SurfaceMesh& mesh) : triangles(mesh.triangles) {
    for (const Eigen::Vector3d& v : mesh.vertices) {
      x.push_back(v.x());
      y.push_back(v.y());
      z.push_back(v.z());
    }
  }
  SurfaceView view() const { return {triangles, x, y, z}; }
  std::vector<std::array<int, 3>> triangles;
  std::vector<double> x, y, z;
};

double signedDistance(const Positions& surface, const Eigen::Vector3d& p) {
  return deepestPoint(surface.view(), p, p).distance;
}

Eigen::Vector3d randomPoint(std::mt19937& generator, double size) {
  const auto next = [&] { return size * (2 * static_cast<double>(generator()) / 4294967295.0 - 1); };
  const double x = next(), y = next(), z = next();
  return {x, y, z};
}

// A spike: the face nearest to a point beyond its tip may look away from the point. One of its faces is cut into
// slivers, which must not count for more than the others where they meet.
SurfaceMesh spike() {
  constexpr int kSlivers = 12;
  SurfaceMesh mesh;
  mesh.vertices = {{0.01, 0, 0}, {-0.01, -0.001, -0.0017}, {-0.01, 0.002, 0}};
  const Eigen::Vector3d last(-0.01, -0.001, 0.0017);
  for (int k = 1; k <= kSlivers; ++k)
    mesh.vertices.push_back(mesh.vertices[2] + static_cast<double>(k) / kSlivers * (last - mesh.vertices[2]));
  for (int k = 0; k < kSlivers; ++k) {
    mesh.triangles.push_back({0, 2 + k, 3 + k});
    mesh.triangles.push_back({1, 3 + k, 2 + k});
  }
  mesh.triangles.push_back({0, 2 + kSlivers, 1});
  mesh.triangles.push_back({0, 1, 2});
  return mesh;
}

bool isInside(const SurfaceMesh& convex, const Eigen::Vector3d& p) {
  for (const auto& t : convex.triangles) {
    const Eigen::Vector3d a = convex.vertices[t[0]];
    if ((convex.vertices[t[1]] - a).cross(convex.vertices[t[2]] - a).dot(p - a) > 0) return false;
  }
  return true;
}

TEST(NeedlePath, TellsInsideFromOutsideAtEdgesAndCorners) {
  std::mt19937 generator(7);
  for (const SurfaceMesh& mesh : {spike(), icosphere(0.01, 0)}) {
    const Positions surface(mesh);
    ASSERT_GT(enclosedVolume(mesh), 0);
    int inside = 0, outside = 0;
    for (int k = 0; k < 4000; ++k) {
      const Eigen::Vector3d p = k % 2 == 0
                                    ? randomPoint(generator, 0.011).cwiseProduct(Eigen::Vector3d(1, 0.5, 0.5)).eval()
                                    : mesh.vertices[0] + randomPoint(generator, 0.002);
      const bool in = isInside(mesh, p);
      in ? ++inside : ++outside;
      EXPECT_EQ(signedDistance(surface, p) < 0, in) << p.transpose();
    }
    EXPECT_GT(std::min(inside, outside), 25);
  }
}

TEST(NeedlePath, FindsTheDeepestPlaceAndItsDistance) {
  const SurfaceMesh ball = icosphere(0.03, 3);
  const Positions surface(ball);
  const Eigen::Vector3d n = ball.vertices[5].normalized();
  for (const double out : {0.0, 1e-3, 4e-3}) {
    const DeepestPoint deepest = deepestPoint(surface.view(), (0.03 + out) * n, 0.02 * n);
    EXPECT_NEAR(deepest.distance, out, 1e-12);
    EXPECT_LT((deepest.point - ball.vertices[5]).norm(), 1e-12);
  }
}

TEST(NeedlePath, FindsAFoldThatItPassesThrough) {
  SurfaceMesh peanut = icosphere(0.03, 4);
  for (Eigen::Vector3d& v : peanut.vertices) {
    const double narrow = 0.3 + 0.7 * std::pow(v.x() / 0.03, 2);
    v.y() *= narrow;
    v.z() *= narrow;
  }
  const Positions surface(peanut);
  const Eigen::Vector3d begin(-0.02, 0.0115, 0), end(0.02, 0.0115, 0);
  EXPECT_LT(signedDistance(surface, begin), 0);
  EXPECT_LT(signedDistance(surface, end), 0);
  const DeepestPoint deepest = deepestPoint(surface.view(), begin, end);
  EXPECT_NEAR(deepest.distance, 0.0025, 0.3e-3) << "above the waist, which has a radius of 9 mm";
  EXPECT_LT(std::abs(deepest.point.x()), 2e-3);
}

// What is left out because it cannot be the nearest, or the deepest, makes no difference.
TEST(NeedlePath, IsTheDeepestOfItsPointsByThemselves) {
  constexpr int kPoints = 64;  // of a path, beside its begin
  SurfaceMesh bumpy = icosphere(0.03, 3);
  std::mt19937 generator(3);
  for (Eigen::Vector3d& v : bumpy.vertices) v += randomPoint(generator, 1.5e-3);
  const Positions surface(bumpy);
  const TriangleTree tree(bumpy);
  for (int k = 0; k < 20; ++k) {
    const Eigen::Vector3d begin = randomPoint(generator, 0.03), end = begin + randomPoint(generator, 0.01);
    double max = -1;
    for (int i = 0; i <= kPoints; ++i) {
      const Eigen::Vector3d p = begin + static_cast<double>(i) / kPoints * (end - begin);
      const double distance = signedDistance(surface, p);
      EXPECT_NEAR(std::abs(distance), tree.closest(p).distance, 1e-15);
      max = std::max(max, distance);
    }
    EXPECT_EQ(deepestPoint(surface.view(), begin, end).distance, max);
  }
}

TEST(NeedlePath, WithoutNumbersThereIsNoSurface) {
  Positions surface(icosphere(0.03, 0));
  for (auto* v : {&surface.x, &surface.y, &surface.z}) v->assign(v->size(), std::nan(""));
  EXPECT_EQ(deepestPoint(surface.view(), Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitX()).triangle, -1);
}

TEST(Needle, GoesAsDeepAsItsPointIsBeyondTheMucosa) {
  Bench bench;
  for (const int vertex : {0, 17, 80}) {
    for (const double beyond : {-0.5e-3, 0.0, 0.4e-3, 3e-3, 50e-3}) {
      bench.goTo(vertex);
      bench.beyond = beyond;
      bench.closeArm();
      // under a vertex the facets are a little nearer to the middle than the ball
      const double want = std::min(beyond + kBenchThickness / 2, 10e-3);
      ASSERT_EQ(bench.count(Event::Kind::Pierced), 1);
      EXPECT_NEAR(bench.procedure().pending.depth, want, beyond < 0 ? 0.15e-3 : 1e-9);
      EXPECT_EQ(bench.procedure().pending.fullThickness(), want >= kBenchThickness - 1e-12);
      EXPECT_NEAR(bench.procedure().pending.thickness, kBenchThickness, 1e-12);
      bench.openArm();
      EXPECT_EQ(bench.count(Event::Kind::BiteWithdrawn), 1);
    }
  }
}

TEST(Needle, MissesWhatItDoesNotReachAndSaysByHowMuch) {
  Bench bench;
  bench.beyond = -6e-3;
  bench.closeArm();
  ASSERT_EQ(bench.count(Event::Kind::BiteMissed), 1);
  EXPECT_FALSE(bench.procedure().pierced);
  EXPECT_NEAR(bench.events.front().value, 6e-3 - kBenchThickness / 2, 1.2e-3) << "the facets lie inside of the ball";
  EXPECT_EQ(bench.count(Event::Kind::PhaseChanged), 0);
}

TEST(Needle, DepthDoesNotDependOnWhereTheWholeWorldIs) {
  Bench bench;
  const auto poses = bench.poses();
  const auto [begin, end] = needlePath(bench.model(), poses);
  const double depth = reachOfNeedle(bench.model(), bench.state(), begin, end).depth;
  const Eigen::Isometry3d move =
      Eigen::Translation3d(0.3, -0.2, 0.1) * Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, 3).normalized());
  State moved = bench.state();
  for (std::size_t i = 0; i < moved.x.size(); ++i) {
    const Eigen::Vector3d p = move * Eigen::Vector3d(moved.x[i], moved.y[i], moved.z[i]);
    moved.x[i] = p.x(), moved.y[i] = p.y(), moved.z[i] = p.z();
  }
  EXPECT_NEAR(reachOfNeedle(bench.model(), moved, move * begin, move * end).depth, depth, 1e-9);
  EXPECT_GT(depth, 1e-3);
}

TEST(BiteAround, PullsOnADiscAroundThePlace) {
  Bench bench(test::benchScene(), 4);  // 2.3 mm between particles
  const Positions wall(bench.model().organ.surface);
  for (const int triangle : {0, 100, 777}) {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (int v : wall.triangles[triangle]) centre += wall.view().position(v) / 3;
    const Bite bite = biteAround(bench.model(), wall.view(), triangle, centre, 5e-3);
    double sum = 0;
    for (std::size_t k = 0; k < bite.particle.size(); ++k) {
      sum += bite.weight[k];
      EXPECT_GT(bite.weight[k], 0);
      EXPECT_LT((wall.view().position(bite.particle[k]) - centre).norm(), 5e-3 + 2.6e-3) << "an edge beyond the disc";
    }
    EXPECT_GT(bite.particle.size(), 10u);
    EXPECT_NEAR(sum, 1, 1e-12);
    EXPECT_LT((bitePosition(bite, wall.x, wall.y, wall.z) - centre).norm(), 0.25e-3) << "the mean of a curved disc";
  }
}

// A disc of the wall at rest: where it is when it is pierced, and how it is stretched there, does not matter.
TEST(BiteAround, IsThatOfTheWallAtRest) {
  Bench bench(test::benchScene(), 4);
  Positions wall(bench.model().organ.surface);
  const auto bite = [&] {
    const auto& v = wall.triangles[100];
    const Eigen::Vector3d p = 0.2 * wall.view().position(v[0]) + 0.3 * wall.view().position(v[1]);
    return biteAround(bench.model(), wall.view(), 100, p + 0.5 * wall.view().position(v[2]), 5e-3);
  };
  const Bite rest = bite();
  for (std::size_t i = 0; i < wall.x.size(); ++i) wall.x[i] = 0.1 - 1.7 * wall.z[i], wall.y[i] *= 0.6;
  const Bite stretched = bite();
  ASSERT_EQ(stretched.particle, rest.particle);
  for (std::size_t k = 0; k < rest.weight.size(); ++k) EXPECT_NEAR(stretched.weight[k], rest.weight[k], 1e-9);
}

TEST(BiteAround, TakesTheCornersOnACoarseMesh) {
  Bench bench(test::benchScene(), 0);  // 31 mm between particles
  const Positions wall(bench.model().organ.surface);
  const auto& corners = wall.triangles[3];
  const Eigen::Vector3d point = 0.9 * wall.view().position(corners[0]) + 0.05 * wall.view().position(corners[1]) +
                                0.05 * wall.view().position(corners[2]);
  const Bite bite = biteAround(bench.model(), wall.view(), 3, point, 4e-3);
  for (int v : corners) EXPECT_NE(std::find(bite.particle.begin(), bite.particle.end(), v), bite.particle.end());
  EXPECT_EQ(nearestParticle(bite), corners[0]);
}

TEST(BiteAround, LeavesTheWallOppositeAlone) {
  Bench bench(test::benchScene(), 4);
  Positions wall(bench.model().organ.surface);
  for (double& z : wall.z) z *= 0.03;  // 1.8 mm from wall to wall in the middle
  const Eigen::Vector3d top(0, 0, 0.03 * kBenchRadius);
  const DeepestPoint place = deepestPoint(wall.view(), 1.1 * top, 1.1 * top);
  const Bite bite = biteAround(bench.model(), wall.view(), place.triangle, place.point, 5e-3);
  int below_in_reach = 0;
  for (int v = 0; v < bench.model().particle_count; ++v)
    below_in_reach += wall.z[v] < 0 && (wall.view().position(v) - place.point).norm() < 5e-3 ? 1 : 0;
  ASSERT_GT(below_in_reach, 5);
  for (int v : bite.particle) EXPECT_GE(wall.z[v], 0) << v;
}

}  // namespace
}  // namespace vibe::needle_test
