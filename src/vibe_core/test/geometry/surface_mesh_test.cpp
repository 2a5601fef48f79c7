#include "vibe_core/geometry/surface_mesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "geometry/test_surfaces.hpp"

namespace vibe::surface_mesh_test {
namespace {

using test::makeBox;
using test::makeUvSphere;

TEST(SurfaceMesh, boxHasTheVolumeAndAreaOfABox) {
  const SurfaceMesh box = makeBox(0.1, 0.2, 0.3);
  EXPECT_NEAR(enclosedVolume(box), 0.006, 1e-15);
  EXPECT_NEAR(surfaceArea(box), 2 * (0.02 + 0.03 + 0.06), 1e-15);
}

TEST(SurfaceMesh, fineSphereApproachesTheBall) {
  const SurfaceMesh sphere = makeUvSphere(0.05, 200, 400);
  EXPECT_NEAR(enclosedVolume(sphere) / (4.0 / 3.0 * M_PI * std::pow(0.05, 3)), 1.0, 2e-4);
  EXPECT_NEAR(surfaceArea(sphere) / (4.0 * M_PI * 0.05 * 0.05), 1.0, 2e-4);
}

TEST(SurfaceMesh, volumeDoesNotDependOnThePlace) {
  SurfaceMesh box = makeBox(0.1, 0.1, 0.1);
  for (auto& v : box.vertices) v += Eigen::Vector3d(1000, -2000, 3000);
  EXPECT_NEAR(enclosedVolume(box), 1e-3, 1e-12);
}

TEST(SurfaceMesh, volumeIsNegativeInsideOut) {
  SurfaceMesh box = makeBox(0.1, 0.1, 0.1);
  for (auto& t : box.triangles) std::swap(t[0], t[1]);
  EXPECT_NEAR(enclosedVolume(box), -1e-3, 1e-15);
}

/// A mesh as a deformed surface.
struct Deformed {
  explicit Deformed(const SurfaceMesh& mesh) : triangles(mesh.triangles) {
    for (const auto& v : mesh.vertices) x.push_back(v.x()), y.push_back(v.y()), z.push_back(v.z());
  }
  SurfaceView view() const { return {triangles, x, y, z}; }
  std::vector<std::array<int, 3>> triangles;
  std::vector<double> x, y, z;
};

TEST(SurfaceMesh, pointsWithinASphereAreFoundAlsoStraightBelowVerticesAndEdges) {
  const SurfaceMesh sphere = makeUvSphere(0.05, 20, 40);
  const Deformed deformed(sphere);
  for (const auto& v : sphere.vertices) {
    for (const double share : {-0.9, 0.0, 0.5, 0.98})
      EXPECT_TRUE(isWithin(deformed.view(), share * v)) << v.transpose();
    if (v.head<2>().norm() < 0.049) {
      EXPECT_TRUE(isWithin(deformed.view(), {v.x(), v.y(), 0.9 * v.z()})) << v.transpose();
    }
    EXPECT_FALSE(isWithin(deformed.view(), 1.02 * v)) << v.transpose();
    EXPECT_FALSE(isWithin(deformed.view(), {v.x(), v.y(), -0.06})) << v.transpose();
  }
}

TEST(SurfaceMesh, nothingIsWithinASphereThatIsInsideOut) {
  SurfaceMesh sphere = makeUvSphere(0.05, 20, 40);
  for (auto& t : sphere.triangles) std::swap(t[0], t[1]);
  EXPECT_FALSE(isWithin(Deformed(sphere).view(), Eigen::Vector3d::Zero()));
}

TEST(SurfaceMesh, whereASurfaceOverlapsItselfIsWithin) {
  SurfaceMesh two = makeBox(0.1, 0.1, 0.1);
  const SurfaceMesh other = makeBox(0.1, 0.1, 0.1);
  for (const auto& v : other.vertices) two.vertices.emplace_back(v + Eigen::Vector3d(0.05, 0.02, 0.03));
  for (const auto& t : other.triangles) two.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  EXPECT_TRUE(isWithin(Deformed(two).view(), {0.02, 0.01, 0.01}));  // in both
  EXPECT_TRUE(isWithin(Deformed(two).view(), {0.08, 0.05, 0.06}));  // in one
  EXPECT_FALSE(isWithin(Deformed(two).view(), {-0.02, 0.06, 0.01}));
}

TEST(SurfaceMesh, vertexAreasSumToTheArea) {
  const SurfaceMesh sphere = makeUvSphere(0.05, 11, 17);
  const auto areas = vertexAreas(sphere);
  EXPECT_NEAR(std::accumulate(areas.begin(), areas.end(), 0.0), surfaceArea(sphere), 1e-14);
}

TEST(SurfaceMesh, normalsOfASphereAreRadial) {
  const SurfaceMesh sphere = makeUvSphere(0.05, 60, 120);
  const auto normals = vertexNormals(sphere);
  for (std::size_t v = 0; v < normals.size(); ++v) {
    EXPECT_GT(normals[v].dot(sphere.vertices[v].normalized()), 0.999);
  }
}

TEST(SurfaceMesh, neighboursAreAscendingAndMutual) {
  const SurfaceMesh sphere = makeUvSphere(0.05, 7, 9);
  const auto neighbours = vertexNeighbours(sphere);
  EXPECT_EQ(neighbours[0].size(), 9u);  // a pole sees its ring
  for (int v = 0; v < static_cast<int>(neighbours.size()); ++v) {
    EXPECT_TRUE(std::is_sorted(neighbours[v].begin(), neighbours[v].end()));
    for (const int n : neighbours[v]) {
      EXPECT_TRUE(std::binary_search(neighbours[n].begin(), neighbours[n].end(), v));
    }
  }
}

TEST(SurfaceMesh, emptyMeshHasNothing) {
  EXPECT_EQ(enclosedVolume(SurfaceMesh{}), 0.0);
  EXPECT_EQ(surfaceArea(SurfaceMesh{}), 0.0);
}

}  // namespace
}  // namespace vibe::surface_mesh_test
