#include "vibe_graphics/geometry/mucosa_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "vibe_graphics/testing/surfaces.hpp"
#include "vibe_graphics/testing/tube_organ.hpp"

namespace vibe::graphics::mucosa_map_test {
namespace {

constexpr double kPi = 3.14159265358979;

double wrappedAngle(double angle) {
  return std::remainder(angle, 2 * kPi);
}

TEST(MucosaMapTest, AngleOfATubeIsThatAroundItsAxis) {
  const test::TubeOrgan organ;
  const MucosaMap map = mapMucosa(organ.mesh());
  ASSERT_EQ(map.of_vertex.size(), organ.rows * organ.around);
  // the tube is open, and its ends turn the angle a little; the quarters are half a particle off their middle
  const std::size_t first = organ.rows / 3 * organ.around, last = 2 * first;
  const auto angleAt = [&](std::size_t v) {
    return std::atan2(map.of_vertex[v].around[1], map.of_vertex[v].around[0]);
  };
  double worst = 0;
  for (std::size_t v = first; v < last; ++v) {
    const double expected = organ.angleOf(static_cast<std::uint32_t>(v) % organ.around);
    worst = std::max(worst, std::abs(wrappedAngle(static_cast<double>(angleAt(v)) - expected)));
    EXPECT_GT(std::hypot(map.of_vertex[v].around[0], map.of_vertex[v].around[1]), 0.99F) << v;
  }
  std::printf("worst error of the angle %.3f rad\n", worst);
  EXPECT_LT(worst, 0.2);  // one of 30 folds; the error varies slowly, so that folds stay whole
  // control: the walls the other way round give another angle
  TissueMesh other = organ.mesh();
  std::rotate(other.wall.begin(), other.wall.begin() + organ.around / 4, other.wall.end());
  const MucosaVertex turned = mapMucosa(other).of_vertex[first];
  const double by = std::atan2(turned.around[1], turned.around[0]) - static_cast<double>(angleAt(first));
  EXPECT_NEAR(std::abs(wrappedAngle(by)), kPi / 2, 0.2);
}

TEST(MucosaMapTest, NothingJumpsBetweenNeighbours) {
  test::TubeOrgan organ;
  TissueMesh mesh = organ.mesh();
  for (std::size_t k = mesh.particle_count / 2; k < mesh.particle_count; ++k) mesh.region[k] = 3;  // antrum
  const MucosaMap map = mapMucosa(mesh);
  for (std::size_t k = 0; k + 1 < mesh.triangles.size(); ++k) {
    const MucosaVertex &a = map.of_vertex[mesh.triangles[k]],
                       &b = map.of_vertex[mesh.triangles[k - k % 3 + (k + 1) % 3]];
    EXPECT_LT(std::abs(a.folded - b.folded), 0.2F);
    EXPECT_LT(std::abs(a.antral - b.antral), 0.2F);
    EXPECT_LT(std::hypot(a.around[0] - b.around[0], a.around[1] - b.around[1]), 0.2F);
  }
  // control: the regions do differ
  EXPECT_GT(map.of_vertex.front().folded, 0.95F);
  EXPECT_LT(map.of_vertex.back().folded, 0.2F);
  EXPECT_GT(map.of_vertex.back().antral, 0.95F);
}

TEST(MucosaMapTest, ZLineLiesWhereTheCardiaBegins) {
  test::TubeOrgan organ;
  TissueMesh mesh = organ.mesh();
  for (std::size_t k = 0; k < organ.around; ++k) mesh.end[k] = 1;  // oesophagus
  const double cardia = 0.06;
  for (std::size_t k = 0; k < mesh.particle_count; ++k)
    if (mesh.rest[3 * k] + 0.1F < cardia) mesh.region[k] = 0;
  const MucosaMap map = mapMucosa(mesh);
  for (std::size_t k = 0; k < mesh.particle_count; k += 7) {
    const double expected = static_cast<double>(mesh.rest[3 * k]) + 0.1 - (cardia - 0.02);
    EXPECT_NEAR(map.of_vertex[k].beyond_z, expected, 0.003) << k;
  }
  EXPECT_EQ(mapMucosa(organ.mesh()).of_vertex[0].beyond_z, 1);  // control: no oesophagus
}

TEST(MucosaMapTest, PylorusIsTheNarrowestPlace) {
  test::TubeOrgan organ;
  organ.radius = 0.015, organ.waist = 0.01, organ.region = 4;
  TissueMesh mesh = organ.mesh();
  for (std::size_t k = mesh.particle_count - organ.around; k < mesh.particle_count; ++k) mesh.end[k] = 2;  // duodenum
  const MucosaMap map = mapMucosa(mesh);
  for (std::size_t k = 0; k < mesh.particle_count; k += 5)
    if (std::abs(mesh.rest[3 * k]) < 0.002F) {
      EXPECT_LT(std::abs(map.of_vertex[k].beyond_ring), 0.006F) << k;
    }
  EXPECT_LT(map.of_vertex.front().beyond_ring, -0.08F);
  EXPECT_GT(map.of_vertex.back().beyond_ring, 0.08F);
}

TEST(MucosaMapTest, WithoutAnatomyThereAreNoFoldsAndARenderSurfaceInterpolates) {
  const MucosaMap bare = mapMucosa(test::ballMesh(9, 12));
  for (const MucosaVertex& vertex : bare.of_vertex) EXPECT_EQ(vertex.folded, 0);
  TissueMesh mesh = test::subdividedBall(9, 12);
  mesh.region.assign(mesh.particle_count, 2);
  mesh.region[0] = 3;
  const MucosaMap map = mapMucosa(mesh);
  ASSERT_EQ(map.of_vertex.size(), mesh.vertex_count);
  float expected = 0;
  for (std::uint32_t k = mesh.render_offsets[0]; k < mesh.render_offsets[1]; ++k)
    expected += mesh.render_weights[k] * map.of_particle[mesh.render_particles[k]].folded;
  EXPECT_NEAR(map.of_vertex[0].folded, expected, 1e-5);
}

}  // namespace
}  // namespace vibe::graphics::mucosa_map_test
