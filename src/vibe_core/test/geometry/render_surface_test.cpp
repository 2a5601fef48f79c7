#include "vibe_core/geometry/surface_mesh.hpp"

#include <gtest/gtest.h>

#include "geometry/test_surfaces.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::render_surface_test {
namespace {

using test::makeUvSphere;

TEST(RenderSurface, hasFourTimesTheTrianglesAndOneVertexPerEdge) {
  const SurfaceMesh sphere = makeUvSphere(0.05, 9, 14);
  const RenderSurface render_surface = makeLoopSubdivision(sphere);
  EXPECT_EQ(render_surface.triangles.size(), 4 * sphere.triangles.size());
  const std::size_t edges = sphere.triangles.size() * 3 / 2;
  EXPECT_EQ(render_surface.offsets.size(), sphere.vertices.size() + edges + 1);
}

TEST(RenderSurface, weightsSumToOne) {
  const RenderSurface render_surface = makeLoopSubdivision(makeUvSphere(0.05, 9, 14));
  for (std::size_t v = 0; v + 1 < render_surface.offsets.size(); ++v) {
    double sum = 0;
    for (int k = render_surface.offsets[v]; k < render_surface.offsets[v + 1]; ++k)
      sum += static_cast<double>(render_surface.weights[k]);
    EXPECT_NEAR(sum, 1.0, 1e-6);
  }
}

TEST(RenderSurface, followsAffineMotion) {
  const SurfaceMesh sphere = makeUvSphere(0.05, 9, 14);
  const RenderSurface render_surface = makeLoopSubdivision(sphere);
  Eigen::Matrix3d stretch;
  stretch << 1.2, 0.3, -0.1, 0.0, 0.8, 0.4, -0.5, 0.1, 1.1;
  const Eigen::Vector3d shift(0.01, -0.02, 0.03);
  std::vector<Eigen::Vector3d> moved;
  for (const auto& v : sphere.vertices) moved.push_back(stretch * v + shift);
  const auto before = renderPositions(render_surface, sphere.vertices), after = renderPositions(render_surface, moved);
  for (std::size_t v = 0; v < before.size(); ++v) {
    EXPECT_LT((after[v] - (stretch * before[v] + shift)).norm(), 1e-8);
  }
}

TEST(RenderSurface, staysClosedAndOutward) {
  const SurfaceMesh sphere = makeUvSphere(0.05, 16, 24);
  const RenderSurface render_surface = makeLoopSubdivision(sphere);
  const SurfaceMesh fine{renderPositions(render_surface, sphere.vertices), render_surface.triangles};
  EXPECT_NEAR(enclosedVolume(fine) / enclosedVolume(sphere), 1.0, 0.05);
  EXPECT_GT(enclosedVolume(fine), 0);
}

TEST(RenderSurface, refusesAnOpenSurface) {
  SurfaceMesh open = makeUvSphere(0.05, 5, 6);
  open.triangles.pop_back();
  EXPECT_THROW(makeLoopSubdivision(open), Error);
}

TEST(RenderSurface, refusesAnEdgeWithThreeTriangles) {
  SurfaceMesh sheet = makeUvSphere(0.05, 5, 6);
  sheet.triangles.push_back(sheet.triangles.front());
  EXPECT_THROW(makeLoopSubdivision(sheet), Error);
}

}  // namespace
}  // namespace vibe::render_surface_test
