#include "vibe_graphics/geometry/deformable_surface.hpp"

#include <gtest/gtest.h>

#include "vibe_graphics/testing/surfaces.hpp"

namespace vibe::graphics::deformable_surface_test {
namespace {

Eigen::Vector3f place(const MovingVertex& v) {
  return {v.position[0], v.position[1], v.position[2]};
}
Eigen::Vector3f normal(const MovingVertex& v) {
  return {v.normal[0], v.normal[1], v.normal[2]};
}

std::vector<float> transformed(const std::vector<float>& points, const Eigen::Affine3f& motion) {
  std::vector<float> result;
  for (std::size_t i = 0; i < points.size(); i += 3) {
    const Eigen::Vector3f p = motion * Eigen::Vector3f(points[i], points[i + 1], points[i + 2]);
    result.insert(result.end(), p.data(), p.data() + 3);
  }
  return result;
}

void expectSame(const DeformableSurface& a, const DeformableSurface& b) {
  ASSERT_EQ(a.vertices().size(), b.vertices().size());
  for (std::size_t v = 0; v < a.vertices().size(); ++v) {
    EXPECT_LT((place(a.vertices()[v]) - place(b.vertices()[v])).norm(), 1e-6F) << v;
    EXPECT_LT((normal(a.vertices()[v]) - normal(b.vertices()[v])).norm(), 1e-5F) << v;
  }
}

float worstNormal(std::uint32_t rows, std::uint32_t around) {
  const TissueMesh mesh = test::ballMesh(rows, around);
  DeformableSurface surface(mesh);
  EXPECT_EQ(surface.update(mesh.rest).count(), mesh.vertex_count);
  float worst = 0;
  for (const MovingVertex& v : surface.vertices()) worst = std::max(worst, (normal(v) - place(v)).norm());
  return worst;
}

TEST(DeformableSurface, NormalsOfABallConvergeToTheRadialDirection) {
  const float coarse = worstNormal(20, 40), fine = worstNormal(40, 80);
  EXPECT_LT(coarse, 0.04F);
  EXPECT_LT(fine, 0.6F * coarse);
}

TEST(DeformableSurface, NormalsRotateWithTheOrgan) {
  const TissueMesh mesh = test::subdividedBall(20, 30);
  DeformableSurface still(mesh), turned(mesh);
  still.update(mesh.rest);
  Eigen::Affine3f motion =
      Eigen::Translation3f(0.3F, -2, 5) * Eigen::AngleAxisf(1.1F, Eigen::Vector3f(1, 2, 3).normalized());
  turned.update(transformed(mesh.rest, motion));
  for (std::size_t v = 0; v < mesh.vertex_count; ++v) {
    EXPECT_LT((motion * place(still.vertices()[v]) - place(turned.vertices()[v])).norm(), 1e-5F);
    EXPECT_LT((motion.linear() * normal(still.vertices()[v]) - normal(turned.vertices()[v])).norm(), 1e-4F);
  }
}

TEST(DeformableSurface, WithoutMotionNothingIsSent) {
  const TissueMesh mesh = test::subdividedBall(20, 30);
  DeformableSurface surface(mesh);
  surface.update(mesh.rest);
  EXPECT_TRUE(surface.update(mesh.rest).empty());
}

class PartlyMoved : public testing::TestWithParam<bool> {};

TEST_P(PartlyMoved, ResultEqualsThatOfAFullUpdate) {
  const TissueMesh mesh = GetParam() ? test::subdividedBall(20, 30) : test::ballMesh(20, 30);
  DeformableSurface kept(mesh), fresh(mesh);
  kept.update(mesh.rest);
  std::vector<float> moved = mesh.rest;
  for (const std::size_t particle : {200U, 201U, 230U, 371U}) moved[3 * particle + 2] *= 0.8F;
  const VertexSpan sent = kept.update(moved);
  fresh.update(moved);
  expectSame(kept, fresh);
  EXPECT_GT(sent.count(), 4U);
  EXPECT_LT(sent.count(), mesh.vertex_count / 2);
}

TEST_P(PartlyMoved, VerticesThatAreNotSentHaveNotChanged) {
  const TissueMesh mesh = GetParam() ? test::subdividedBall(20, 30) : test::ballMesh(20, 30);
  DeformableSurface surface(mesh);
  surface.update(mesh.rest);
  const std::vector<MovingVertex> before = surface.vertices();
  std::vector<float> moved = mesh.rest;
  moved[3 * 300] += 0.1F;
  const VertexSpan sent = surface.update(moved);
  for (std::size_t v = 0; v < before.size(); ++v) {
    if (v >= sent.first && v < sent.last) continue;
    EXPECT_EQ(place(before[v]), place(surface.vertices()[v]));
    EXPECT_EQ(normal(before[v]), normal(surface.vertices()[v]));
  }
}

INSTANTIATE_TEST_SUITE_P(WithAndWithoutSkin, PartlyMoved, testing::Bool());

TEST(DeformableSurface, BoundsAreTight) {
  const TissueMesh mesh = test::ballMesh(21, 40);
  DeformableSurface surface(mesh);
  EXPECT_TRUE(surface.bounds().isEmpty());
  surface.update(mesh.rest);
  EXPECT_NEAR(surface.bounds().min().z(), -1, 1e-6);
  EXPECT_NEAR(surface.bounds().max().x(), 1, 1e-6);
  std::vector<float> moved = mesh.rest;
  moved[2] = 3;  // the pole
  surface.update(moved);
  EXPECT_NEAR(surface.bounds().max().z(), 3, 1e-6);
}

TEST(DeformableSurface, TrianglesWithoutAreaGiveNoNaN) {
  TissueMesh mesh = test::ballMesh(5, 6);
  DeformableSurface surface(mesh);
  surface.update(std::vector<float>(mesh.rest.size(), 0.25F));
  for (const MovingVertex& v : surface.vertices()) EXPECT_TRUE(normal(v).allFinite());
}

}  // namespace
}  // namespace vibe::graphics::deformable_surface_test
