#include "vibe_core/scene/mesh_guess.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>

#include "geometry/landmark_estimate.hpp"
#include "vibe_core/builder/organ_builder.hpp"
#include "vibe_core/common/error.hpp"

namespace vibe {
namespace {

Organ stomach() {
  Scene scene;
  scene.geometry.particles = 1500;
  return buildOrgan(scene);
}

TEST(LandmarkEstimate, FindsThoseOfTheProceduralStomach) {
  const Organ organ = stomach();
  const Landmarks found = estimateLandmarks(organ.surface);
  EXPECT_LT((found.fundus - organ.landmarks.fundus).norm(), 0.02);
  EXPECT_LT((found.pylorus - organ.landmarks.pylorus).norm(), 0.03);
  EXPECT_LT((found.oesophagus - organ.landmarks.oesophagus).norm(), 0.04);
  EXPECT_LT((found.incisura - organ.landmarks.incisura).norm(), 0.05);
  // control: upside down it is another stomach
  SurfaceMesh turned = organ.surface;
  for (auto& v : turned.vertices) v = -v;
  EXPECT_GT((estimateLandmarks(turned).fundus + organ.landmarks.fundus).norm(), 0.05);
}

class MeshGuess : public ::testing::Test {
 protected:
  std::string file = ::testing::TempDir() + "mesh_guess_test.obj";
  ~MeshGuess() override { std::remove(file.c_str()); }
  // in millimetres, x to the left, y to the back, z up
  void write(const SurfaceMesh& mesh) {
    std::ofstream out(file);
    for (const auto& v : mesh.vertices) out << "v " << 1e3 * v.y() << ' ' << -1e3 * v.x() << ' ' << 1e3 * v.z() << '\n';
    for (const auto& t : mesh.triangles) out << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
  }
};

TEST_F(MeshGuess, BringsAStomachHomeFromAnotherFrame) {
  const Organ original = stomach();
  write(original.surface);
  Scene scene;
  scene.geometry.particles = 1500;
  const std::string remark = useMesh(scene, file);
  EXPECT_NE(remark.find("guesses"), std::string::npos);
  EXPECT_NE(remark.find("unit: 0.001"), std::string::npos);
  EXPECT_NE(remark.find("mesh_guess_test.obj.landmarks.yaml"), std::string::npos);
  const Organ imported = buildOrgan(scene);
  EXPECT_NEAR(enclosedVolume(imported.surface), enclosedVolume(original.surface), 0.01 * 0.9e-3);
  EXPECT_LT((imported.landmarks.fundus - original.landmarks.fundus).norm(), 0.03);
  EXPECT_LT((imported.landmarks.pylorus - original.landmarks.pylorus).norm(), 0.03);
}

TEST_F(MeshGuess, StatedLandmarksAreNotGuessed) {
  const Organ original = stomach();
  write(original.surface);
  Scene scene;
  scene.geometry.unit = 1e-3;
  scene.geometry.oesophagus = scene.geometry.fundus = scene.geometry.incisura = scene.geometry.pylorus =
      Eigen::Vector3d(1, 2, 3);
  EXPECT_EQ(useMesh(scene, file), "");
  EXPECT_EQ(*scene.geometry.fundus, Eigen::Vector3d(1, 2, 3));
}

TEST_F(MeshGuess, SaysWhatIsWrongWithTheFile) {
  Scene scene;
  EXPECT_THROW(useMesh(scene, file + ".missing.obj"), Error);
  std::ofstream(file) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  EXPECT_THROW(useMesh(scene, file), Error);
}

}  // namespace
}  // namespace vibe
