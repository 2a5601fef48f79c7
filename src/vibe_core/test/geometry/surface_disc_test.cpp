// A disc of a surface is the same whatever mesh it lies on.
#include "vibe_core/geometry/surface_disc.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <random>

#include "vibe_core/geometry/triangle_tree.hpp"
#include "vibe_testing/worlds.hpp"

namespace vibe::surface_disc_test {
namespace {

using test::icosphere;

constexpr double kRadius = 4e-3;

/// A square plate with inner vertices moved at random and diagonals in both directions.
SurfaceMesh plate(double side, int cells, unsigned seed) {
  std::mt19937 generator(seed);
  const auto next = [&] { return static_cast<double>(generator()) / 4294967296.0 - 0.5; };
  SurfaceMesh mesh;
  const double h = side / cells;
  for (int i = 0; i <= cells; ++i)
    for (int k = 0; k <= cells; ++k) {
      const double jitter = i % cells != 0 && k % cells != 0 ? 0.5 * h : 0, x = jitter * next(), y = jitter * next();
      mesh.vertices.emplace_back(h * i - side / 2 + x, h * k - side / 2 + y, 0);
    }
  const auto at = [&](int i, int k) { return i * (cells + 1) + k; };
  for (int i = 0; i < cells; ++i)
    for (int k = 0; k < cells; ++k) {
      const int a = at(i, k), b = at(i + 1, k), c = at(i + 1, k + 1), d = at(i, k + 1);
      if ((i + k) % 2 == 0)
        mesh.triangles.push_back({a, b, c}), mesh.triangles.push_back({a, c, d});
      else
        mesh.triangles.push_back({a, b, d}), mesh.triangles.push_back({b, c, d});
    }
  return mesh;
}

DiscWeights discAt(const SurfaceMesh& mesh, const Eigen::Vector3d& p, double radius = kRadius) {
  const TriangleTree::Hit hit = TriangleTree(mesh).closest(p);
  return discWeights(mesh, hit.triangle, hit.point, radius);
}

template <class Field>
double meanOver(const DiscWeights& disc, const SurfaceMesh& mesh, const Field& field) {
  double sum = 0;
  for (std::size_t k = 0; k < disc.vertex.size(); ++k) sum += disc.weight[k] * field(mesh.vertices[disc.vertex[k]]);
  return sum;
}

Eigen::Vector3d placeOf(const DiscWeights& disc, const SurfaceMesh& mesh) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < disc.vertex.size(); ++k) sum += disc.weight[k] * mesh.vertices[disc.vertex[k]];
  return sum;
}

/// Every triangle divided into four flat ones; `middle` are the new vertices by their edges.
SurfaceMesh divided(const SurfaceMesh& mesh, std::map<std::pair<int, int>, int>& middle) {
  SurfaceMesh fine{mesh.vertices, {}};
  const auto between = [&](int a, int b) {
    const auto [at, is_new] = middle.try_emplace(std::minmax(a, b), static_cast<int>(fine.vertices.size()));
    if (is_new) fine.vertices.push_back(0.5 * (mesh.vertices[a] + mesh.vertices[b]));
    return at->second;
  };
  for (const auto& t : mesh.triangles) {
    const int a = between(t[0], t[1]), b = between(t[1], t[2]), c = between(t[2], t[0]);
    fine.triangles.insert(fine.triangles.end(), {{t[0], a, c}, {a, t[1], b}, {c, b, t[2]}, {a, b, c}});
  }
  return fine;
}

TEST(SurfaceDisc, HasTheMeanOfEveryLinearFieldOnEveryMesh) {
  std::mt19937 generator(3);
  for (const int cells : {4, 13, 40})
    for (unsigned seed = 0; seed < 8; ++seed) {
      const SurfaceMesh mesh = plate(0.05, cells, seed);
      const auto next = [&] { return 0.03 * (static_cast<double>(generator()) / 4294967296.0 - 0.5); };
      const double x = next(), y = next();
      const DiscWeights disc = discAt(mesh, {x, y, 0});
      EXPECT_NEAR(std::accumulate(disc.weight.begin(), disc.weight.end(), 0.0), 1, 1e-14);
      EXPECT_GT(*std::min_element(disc.weight.begin(), disc.weight.end()), 0);
      EXPECT_TRUE(std::is_sorted(disc.vertex.begin(), disc.vertex.end()));
      EXPECT_LT((placeOf(disc, mesh) - Eigen::Vector3d(x, y, 0)).norm(), 1e-12) << cells << " cells";
    }
}

// Negative control: the vertices inside of the disc with their areas, which is what one might take instead.
TEST(SurfaceDisc, VerticesInsideWithTheirAreasHaveAnotherMean) {
  const SurfaceMesh mesh = plate(0.05, 13, 1);
  const std::vector<double> area = vertexAreas(mesh);
  const Eigen::Vector3d centre(1e-3, 2e-3, 0);
  DiscWeights inside;
  double sum = 0;
  for (int v = 0; v < static_cast<int>(mesh.vertices.size()); ++v)
    if ((mesh.vertices[v] - centre).norm() < kRadius) inside.vertex.push_back(v), sum += area[v];
  ASSERT_GT(inside.vertex.size(), 1u);
  for (int v : inside.vertex) inside.weight.push_back(area[v] / sum);
  EXPECT_GT((placeOf(inside, mesh) - centre).norm(), 2e-4);
}

TEST(SurfaceDisc, OnACoarseMeshIsOfTheCornersOfOneTriangle) {
  const SurfaceMesh mesh = plate(0.1, 4, 2);
  const auto& t = mesh.triangles[9];
  const Eigen::Vector3d share(0.3, 0.3, 0.4);
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k) centre += share[k] * mesh.vertices[t[k]];
  const DiscWeights disc = discWeights(mesh, 9, centre, 2e-3);
  ASSERT_EQ(disc.vertex.size(), 3u);
  for (int k = 0; k < 3; ++k) {
    const auto at = std::find(disc.vertex.begin(), disc.vertex.end(), t[k]);
    ASSERT_NE(at, disc.vertex.end());
    EXPECT_NEAR(disc.weight[at - disc.vertex.begin()], share[k], 1e-12);
  }
}

// The mean square of the distance from the centre is half of the square of the radius; hats overestimate it.
TEST(SurfaceDisc, HasItsArea) {
  const Eigen::Vector3d centre(1e-3, 2e-3, 0);
  double last = 0;
  for (const int cells : {20, 40, 80}) {
    const SurfaceMesh mesh = plate(0.05, cells, 5);
    const double square =
        meanOver(discAt(mesh, centre), mesh, [&](const Eigen::Vector3d& p) { return (p - centre).squaredNorm(); });
    const double error = square / (0.5 * kRadius * kRadius) - 1;
    EXPECT_GT(error, 0);
    if (last > 0) {
      EXPECT_NEAR(last / error, 4, 1.2) << "second order";
    }
    last = error;
  }
  EXPECT_LT(last, 0.02);
}

// On a mesh whose triangles are divided, the surface is the same one, and every coarse hat is a sum of fine ones.
TEST(SurfaceDisc, IsTheSameOnADividedMesh) {
  const SurfaceMesh coarse = icosphere(0.03, 2);
  std::map<std::pair<int, int>, int> middle;
  const SurfaceMesh fine = divided(coarse, middle);
  for (const int triangle : {0, 77, 200}) {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (int k = 0; k < 3; ++k) centre += (k + 1) / 6.0 * coarse.vertices[coarse.triangles[triangle][k]];
    const DiscWeights wide = discAt(coarse, centre, 5e-3), narrow = discAt(fine, centre, 5e-3);
    std::vector<double> rest(fine.vertices.size(), 0.0);
    for (std::size_t k = 0; k < narrow.vertex.size(); ++k) rest[narrow.vertex[k]] += narrow.weight[k];
    for (const auto& [edge, v] : middle) rest[edge.first] += 0.5 * rest[v], rest[edge.second] += 0.5 * rest[v];
    for (std::size_t k = 0; k < wide.vertex.size(); ++k)
      EXPECT_NEAR(rest[wide.vertex[k]], wide.weight[k], 1e-12) << triangle;
    const DiscWeights other = discAt(fine, centre, 4.5e-3);
    EXPECT_GT((placeOf(other, fine) - placeOf(wide, coarse)).norm(), 1e-5) << "another radius is another disc";
  }
}

TEST(SurfaceDisc, TurnsAndMovesWithTheSurface) {
  const SurfaceMesh ball = icosphere(0.03, 3);
  const Eigen::Isometry3d move =
      Eigen::Translation3d(0.3, -0.2, 0.1) * Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, 3).normalized());
  SurfaceMesh moved = ball;
  for (Eigen::Vector3d& v : moved.vertices) v = move * v;
  for (auto& t : moved.triangles) std::rotate(t.begin(), t.begin() + 1, t.end());
  const Eigen::Vector3d p = 0.5 * (ball.vertices[100] + ball.vertices[101]);
  const DiscWeights here = discAt(ball, p), there = discAt(moved, move * p);
  ASSERT_EQ(here.vertex, there.vertex);
  for (std::size_t k = 0; k < here.vertex.size(); ++k) EXPECT_NEAR(here.weight[k], there.weight[k], 1e-12);
}

TEST(SurfaceDisc, LeavesASurfaceOppositeAlone) {
  SurfaceMesh flat = icosphere(0.03, 4);
  for (Eigen::Vector3d& v : flat.vertices) v.z() *= 0.03;
  for (const int v : discAt(flat, {0, 0, 1e-3}, 5e-3).vertex) EXPECT_GE(flat.vertices[v].z(), 0) << v;
}

TEST(SurfaceDisc, EndsWhereTheSurfaceEnds) {
  const SurfaceMesh mesh = plate(0.05, 13, 4);
  const DiscWeights disc = discAt(mesh, {0.025, 0, 0});
  const Eigen::Vector3d half = placeOf(disc, mesh);
  EXPECT_NEAR(half.x(), 0.025 - 4 * kRadius / (3 * M_PI), 1e-9) << "the centroid of half a disc";
  EXPECT_NEAR(half.y(), 0, 1e-9);
}

}  // namespace
}  // namespace vibe::surface_disc_test
