#include "tissue/shell_tissue.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "vibe_core/builder/model_builder.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_testing/worlds.hpp"

namespace vibe::shell_tissue_test {
namespace {

using test::icosphere;
using test::plainOrgan;

TissueScene wall() {
  TissueScene tissue;
  tissue.model = "shell";
  return tissue;
}

/// A ball whose upper half is fundus; its axis is z.
Organ ball() {
  Organ organ = plainOrgan(icosphere(0.05, 3), 2e-3);
  for (std::size_t i = 0; i < organ.region.size(); ++i)
    if (organ.surface.vertices[i].z() > 0) organ.region[i] = Region::Fundus;
  organ.landmarks.fundus = {0, 0, 0.05};
  organ.landmarks.pylorus = {0, 0, -0.05};
  return organ;
}

ShellMesh meshOf(const TissueScene& tissue, const Organ& organ) {
  return ShellTissue(tissue, organ, std::vector<char>(organ.region.size(), 0)).elements()->mesh();
}

TEST(ShellTissue, IsOneMaterialWithoutFibresUnlessTheSceneSaysOtherwise) {
  const ShellMesh mesh = meshOf(wall(), ball());
  ASSERT_EQ(mesh.materials.size(), 1u);
  EXPECT_EQ(mesh.materials[0].young_modulus, wall().young_modulus);
  EXPECT_TRUE(mesh.fibres.modulus.empty());
}

TEST(ShellTissue, StiffnessIsByRegionAndTheMeanBetweenTwo) {
  TissueScene tissue = wall();
  tissue.stiffness[static_cast<int>(Region::Fundus)] = 4;
  const Organ organ = ball();
  const ShellMesh mesh = meshOf(tissue, organ);
  EXPECT_EQ(mesh.materials.size(), 4u);
  for (std::size_t e = 0; e < mesh.triangles.size(); ++e) {
    int above = 0;
    for (const int node : mesh.triangles[e]) above += mesh.nodes[static_cast<std::size_t>(node)].z() > 0 ? 1 : 0;
    EXPECT_DOUBLE_EQ(mesh.materials[static_cast<std::size_t>(mesh.material[e])].young_modulus,
                     tissue.young_modulus * (1 + above));
  }
}

TEST(ShellTissue, FibresRunAtTheirAngleToTheAxis) {
  for (const double angle : {0.0, 0.5, M_PI / 2}) {
    TissueScene tissue = wall();
    tissue.stiffness[static_cast<int>(Region::Fundus)] = 4;
    tissue.fibres = FibreScene{2e4, 3, angle};
    const ShellMesh mesh = meshOf(tissue, ball());
    EXPECT_EQ(mesh.fibres.stiffening, 3);
    for (std::size_t e = 0; e < mesh.triangles.size(); ++e) {
      const auto& t = mesh.triangles[e];
      const Eigen::Vector3d a = mesh.nodes[static_cast<std::size_t>(t[0])];
      const Eigen::Vector3d normal = (mesh.nodes[static_cast<std::size_t>(t[1])] - a)
                                         .cross(mesh.nodes[static_cast<std::size_t>(t[2])] - a)
                                         .normalized();
      if (std::abs(normal.z()) > 0.95) continue;
      const Eigen::Vector3d down = (normal.z() * normal - Eigen::Vector3d::UnitZ()).normalized();
      for (const Eigen::Vector3d& d : mesh.fibres.direction[e]) {
        EXPECT_NEAR(d.dot(normal), 0, 1e-12);
        EXPECT_NEAR(d.dot(down), std::cos(angle), 1e-12);
      }
      EXPECT_NEAR(mesh.fibres.modulus[e],
                  2e4 * mesh.materials[static_cast<std::size_t>(mesh.material[e])].young_modulus / tissue.young_modulus,
                  1e-9);
    }
  }
}

/// Length over width of the ball under gas, both over those at rest.
double slenderness(const std::optional<FibreScene>& fibres) {
  Scene scene;
  scene.tissue = wall();
  scene.tissue.fibres = fibres;
  scene.foundation = FoundationScene{};
  scene.foundation->stiffness = 100;
  scene.gas = GasScene{};
  scene.gas->insufflator_on = true;
  scene.gas->flow_limit = 1e-3;
  test::World world(scene, ball());
  world.run(2);
  double length = 0, width = 0;
  for (int i = 0; i < world.model->particle_count; ++i)
    length = std::max(length, world.position(i).z()), width = std::max(width, world.position(i).x());
  return length / width;
}

TEST(ShellTissue, FilledBallGrowsAcrossItsFibres) {
  EXPECT_NEAR(slenderness({}), 1, 2e-3);
  EXPECT_LT(slenderness(FibreScene{2e4, 1, 0}), 0.99);
  EXPECT_GT(slenderness(FibreScene{2e4, 1, M_PI / 2}), 1.01);
}

TEST(ShellTissue, FibresNeedAnAxis) {
  TissueScene tissue = wall();
  tissue.fibres = FibreScene{};
  EXPECT_THROW(meshOf(tissue, plainOrgan(icosphere(0.05, 2), 2e-3)), Error);
}

TEST(ShellTissue, StomachHasFibresAlongItsAxisOfUnitLength) {
  Scene scene;
  scene.geometry.particles = 800;
  scene.tissue.fibres = FibreScene{};
  const Organ organ = buildOrgan(scene);
  const ShellMesh mesh = meshOf(scene.tissue, organ);
  // the axis goes from the fundus to the pylorus: beside the antrum, to the patient's right
  double right = 0;
  for (std::size_t e = 0; e < mesh.triangles.size(); ++e) {
    EXPECT_NEAR(mesh.fibres.direction[e][0].norm(), 1, 1e-9);
    if (organ.region[mesh.triangles[e][0]] == Region::Antrum) right -= mesh.fibres.direction[e][0].y();
  }
  EXPECT_GT(right, 0);
}

}  // namespace
}  // namespace vibe::shell_tissue_test
