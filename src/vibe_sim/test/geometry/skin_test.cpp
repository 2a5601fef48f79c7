#include "vibe_sim/geometry/skin.hpp"

#include <gtest/gtest.h>

#include "test_surfaces.hpp"
#include "vibe_sim/error.hpp"

namespace vibe {
namespace {

using test::makeUvSphere;

TEST(Skin, hasFourTimesTheTrianglesAndOneVertexPerEdge) {
  const SurfaceMesh sphere = makeUvSphere(0.05, 9, 14);
  const Skin skin = makeLoopSkin(sphere);
  EXPECT_EQ(skin.triangles.size(), 4 * sphere.triangles.size());
  const std::size_t edges = sphere.triangles.size() * 3 / 2;
  EXPECT_EQ(skin.offsets.size(), sphere.vertices.size() + edges + 1);
}

TEST(Skin, weightsSumToOne) {
  const Skin skin = makeLoopSkin(makeUvSphere(0.05, 9, 14));
  for (std::size_t v = 0; v + 1 < skin.offsets.size(); ++v) {
    double sum = 0;
    for (int k = skin.offsets[v]; k < skin.offsets[v + 1]; ++k) sum += static_cast<double>(skin.weights[k]);
    EXPECT_NEAR(sum, 1.0, 1e-6);
  }
}

TEST(Skin, followsAffineMotion) {
  const SurfaceMesh sphere = makeUvSphere(0.05, 9, 14);
  const Skin skin = makeLoopSkin(sphere);
  Eigen::Matrix3d stretch;
  stretch << 1.2, 0.3, -0.1, 0.0, 0.8, 0.4, -0.5, 0.1, 1.1;
  const Eigen::Vector3d shift(0.01, -0.02, 0.03);
  std::vector<Eigen::Vector3d> moved;
  for (const auto& v : sphere.vertices) moved.push_back(stretch * v + shift);
  const auto before = skinPositions(skin, sphere.vertices), after = skinPositions(skin, moved);
  for (std::size_t v = 0; v < before.size(); ++v) {
    EXPECT_LT((after[v] - (stretch * before[v] + shift)).norm(), 1e-8);
  }
}

TEST(Skin, staysClosedAndOutward) {
  const SurfaceMesh sphere = makeUvSphere(0.05, 16, 24);
  const Skin skin = makeLoopSkin(sphere);
  const SurfaceMesh fine{skinPositions(skin, sphere.vertices), skin.triangles};
  EXPECT_NEAR(enclosedVolume(fine) / enclosedVolume(sphere), 1.0, 0.05);
  EXPECT_GT(enclosedVolume(fine), 0);
}

TEST(Skin, refusesAnOpenSurface) {
  SurfaceMesh open = makeUvSphere(0.05, 5, 6);
  open.triangles.pop_back();
  EXPECT_THROW(makeLoopSkin(open), Error);
}

TEST(Skin, refusesAnEdgeWithThreeTriangles) {
  SurfaceMesh sheet = makeUvSphere(0.05, 5, 6);
  sheet.triangles.push_back(sheet.triangles.front());
  EXPECT_THROW(makeLoopSkin(sheet), Error);
}

}  // namespace
}  // namespace vibe
