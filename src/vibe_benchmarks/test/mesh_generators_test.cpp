#include "fem/bench_mesh.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "fem/vibration.hpp"
#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe::benchmarks::mesh_generators_test {
namespace {

double volumeOf(const BenchMesh& mesh, const std::array<int, 4>& t) {
  const Eigen::Vector3d a = mesh.nodes[t[0]];
  return (mesh.nodes[t[1]] - a).cross(mesh.nodes[t[2]] - a).dot(mesh.nodes[t[3]] - a) / 6;
}

TEST(MeshGenerators, fillABoxWithPositiveTetrahedraThatMatch) {
  for (const int per_cell : {5, 6}) {
    const BenchMesh mesh = makeBox({1, 2, 3}, {0.3, 0.2, 0.1}, {3, 2, 2}, per_cell);
    EXPECT_EQ(mesh.tets.size(), 12U * per_cell);
    double volume = 0;
    std::map<std::array<int, 3>, int> faces;
    for (const auto& t : mesh.tets) {
      EXPECT_GT(volumeOf(mesh, t), 0);
      volume += volumeOf(mesh, t);
      for (int skip = 0; skip < 4; ++skip) {
        std::array<int, 3> face{};
        for (int k = 0, at = 0; k < 4; ++k)
          if (k != skip) face[at++] = t[k];
        std::sort(face.begin(), face.end());
        ++faces[face];
      }
    }
    EXPECT_NEAR(volume, 0.006, 1e-12);
    // boundary: two triangles per cell face; all other triangles are shared by two elements
    const auto outside = std::count_if(faces.begin(), faces.end(), [](const auto& f) { return f.second == 1; });
    EXPECT_EQ(outside, 2 * 2 * (3 * 2 + 3 * 2 + 2 * 2));
    EXPECT_EQ(mesh.sets.at("y_max").size(), 4U * 3U);
  }
}

TEST(MeshGenerators, makeClosedEllipsoidsOfExactlySoManyNodes) {
  for (const int nodes : {14, 100, 1000, 3618}) {
    const BenchMesh mesh = makeEllipsoid(0.04325, 0.12325, nodes);
    EXPECT_EQ(mesh.nodes.size(), static_cast<std::size_t>(nodes));
    EXPECT_EQ(mesh.triangles.size(), 2U * (nodes - 2));  // Euler: closed, genus 0
    std::map<std::array<int, 2>, int> sides;
    for (const auto& t : mesh.triangles)
      for (std::size_t k = 0; k < 3; ++k) ++sides[{t[k], t[(k + 1) % 3]}];
    for (const auto& side : sides) {
      EXPECT_EQ(side.second, 1);
      EXPECT_EQ(sides.count({side.first[1], side.first[0]}), 1U);
    }
    if (nodes < 1000) continue;
    const double whole = 4.0 / 3 * std::acos(-1.0) * 0.04325 * 0.04325 * 0.12325;
    EXPECT_NEAR(enclosedVolume(SurfaceMesh{mesh.nodes, mesh.triangles}) / whole, 1, 10.0 / nodes);
  }
}

TEST(MeshGenerators, gradeEllipsoidsTowardsTheirPoles) {
  const BenchMesh mesh = makeGradedEllipsoid(0.05, 0.08, 0.005, 0.0005);
  std::map<std::array<int, 2>, int> sides;
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) ++sides[{t[k], t[(k + 1) % 3]}];
  for (const auto& side : sides) {
    EXPECT_EQ(sides.count({side.first[1], side.first[0]}), 1U);
    const Eigen::Vector3d &a = mesh.nodes[side.first[0]], &b = mesh.nodes[side.first[1]];
    const double from_pole = std::hypot(a.x(), a.y());
    EXPECT_LT((a - b).norm(), std::min(0.0075, 1.6 * (0.0005 + 0.3 * from_pole)));
  }
  const double whole = 4.0 / 3 * std::acos(-1.0) * 0.05 * 0.05 * 0.08;
  EXPECT_NEAR(enclosedVolume(SurfaceMesh{mesh.nodes, mesh.triangles}) / whole, 1, 0.01);
}

TEST(MeshGenerators, fillACylinderWithPositiveTetrahedraThatMatch) {
  const BenchMesh mesh = makeCylinder(0.025, 0.03, 3, 4);
  double volume = 0;
  std::map<std::array<int, 3>, int> faces;
  for (const auto& t : mesh.tets) {
    EXPECT_GT(volumeOf(mesh, t), 0);
    volume += volumeOf(mesh, t);
    for (std::size_t skip = 0; skip < 4; ++skip) {
      std::array<int, 3> face{t[(skip + 1) % 4], t[(skip + 2) % 4], t[(skip + 3) % 4]};
      std::sort(face.begin(), face.end());
      ++faces[face];
    }
  }
  const double corners = 18;  // of the outline
  EXPECT_NEAR(volume, 0.03 * corners / 2 * 0.025 * 0.025 * std::sin(2 * std::acos(-1.0) / corners), 1e-12);
  const auto outside = std::count_if(faces.begin(), faces.end(), [](const auto& f) { return f.second == 1; });
  EXPECT_EQ(outside, 2 * 54 + 2 * 18 * 4);  // both ends and the side
  EXPECT_EQ(mesh.sets.at("z_max").size(), 1U + 6 + 12 + 18);
}

TEST(MeshGenerators, refiningKeepsSidesAndSets) {
  BenchMesh mesh = makeEllipsoid(0.04, 0.04, 200);
  mesh.sets["pair"] = {mesh.triangles[0][0], mesh.triangles[0][1]};
  const BenchMesh fine = refineTriangles(mesh, Eigen::Vector3d::Constant(0.04));
  EXPECT_EQ(fine.triangles.size(), 4 * mesh.triangles.size());
  EXPECT_EQ(fine.nodes.size(), 200U + 3U * 198U);
  ASSERT_EQ(fine.sets.at("pair").size(), 3U);
  for (const auto& node : fine.nodes) EXPECT_NEAR(node.norm(), 0.04, 1e-12);
}

TEST(Oscillation, measuresADampedSine) {
  std::vector<double> values;
  const double frequency = 3.1, step = 1.0 / 240, pi = std::acos(-1.0);
  for (int i = 0; i < 480; ++i) {
    const double t = i * step;
    values.push_back(std::exp(-0.2 * t) * std::cos(2 * pi * frequency * t));
  }
  const Oscillation found = measureOscillation(values, step);
  EXPECT_NEAR(found.frequency, frequency, 0.005);
  EXPECT_NEAR(found.kept, std::exp(-0.2 / frequency), 0.002);
  EXPECT_TRUE(std::isnan(measureOscillation({0, 1, 0, -1}, step).frequency));
}

}  // namespace
}  // namespace vibe::benchmarks::mesh_generators_test
