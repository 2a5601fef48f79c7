#include "vibe_core/scene/scene_parser.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iomanip>

#include "scene/size_estimate.hpp"
#include "vibe_core/builder/model_builder.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::mesh_guess_test {
namespace {

Organ stomach() {
  Scene scene;
  scene.geometry.particles = 1500;
  return buildOrgan(scene);
}

class MeshGuess : public ::testing::Test {
 protected:
  std::string file = ::testing::TempDir() + "mesh_guess_test.obj";
  ~MeshGuess() override { std::remove(file.c_str()); }
  // x to the left, y to the back, z up
  void write(const SurfaceMesh& mesh, double per_metre = 1e3) {
    std::ofstream out(file);
    out << std::setprecision(9);
    for (const auto& v : mesh.vertices)
      out << "v " << per_metre * v.y() << ' ' << -per_metre * v.x() << ' ' << per_metre * v.z() << '\n';
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
  EXPECT_NE(remark.find("confidence 1.00 of 1"), std::string::npos);
  EXPECT_EQ(remark.find("doubtful"), std::string::npos);
  EXPECT_DOUBLE_EQ(scene.geometry.landmark_confidence.value_or(0), 1);
  EXPECT_EQ(landmarkRemark(scene), "landmarks          guessed, confidence 1.00\n");
  EXPECT_NE(remark.find("mesh_guess_test.obj.landmarks.yaml"), std::string::npos);
  const Organ imported = buildOrgan(scene);
  EXPECT_NEAR(enclosedVolume(imported.surface), enclosedVolume(original.surface), 0.01 * 0.9e-3);
  EXPECT_LT((imported.landmarks.fundus - original.landmarks.fundus).norm(), 0.03);
  EXPECT_LT((imported.landmarks.pylorus - original.landmarks.pylorus).norm(), 0.03);
}

TEST_F(MeshGuess, TriesEveryUnitThatASidecarKnows) {
  const SurfaceMesh surface = stomach().surface;
  for (const LengthUnit& unit : lengthUnits()) {
    write(surface, 1 / unit.metres);
    Scene scene;
    const std::string remark = useMesh(scene, file);
    EXPECT_NEAR(scene.geometry.unit / unit.metres, 1, 1e-12) << unit.name;
    EXPECT_EQ(remark.find("doubtful"), std::string::npos) << remark;
  }
  EXPECT_GE(lengthUnits().size(), 6U);
}

TEST_F(MeshGuess, DoubtsASizeThatNoStomachHas) {
  // 45,000 voxels: 45 L in centimetres, 45 mL in millimetres, 0.7 m3 in inches
  SurfaceMesh surface = stomach().surface;
  const double factor = std::cbrt(45.0e-6 / enclosedVolume(surface));
  for (auto& v : surface.vertices) v *= factor;
  write(surface);
  Scene scene;
  const std::string remark = useMesh(scene, file);
  EXPECT_NE(
      remark.find("The unit of " + file + " is doubtful: taken as mm, it holds 45 mL, and stomachs hold 0.1 to 3 L"),
      std::string::npos)
      << remark;
  EXPECT_LT(scene.geometry.landmark_confidence.value_or(1), 0.6);
  // who states the unit is not doubted
  scene = Scene();
  scene.geometry.unit = 1e-3;
  EXPECT_EQ(useMesh(scene, file).find("The unit"), std::string::npos);
}

TEST(SizeEstimate, MarksVolumeWallAndLength) {
  const SurfaceMesh surface = stomach().surface;
  const auto scaled = [&](double litres) {
    SurfaceMesh mesh = surface;
    for (auto& v : mesh.vertices) v *= std::cbrt(litres * 1e-3 / enclosedVolume(surface));
    return mesh;
  };
  for (const double litres : {0.3, 0.6, 0.9, 1.5, 2.0})
    EXPECT_EQ(estimateUnit(scaled(litres), 2.3e-3).confidence, 1) << litres;
  for (const double litres : {0.02, 0.05, 4.5, 5.9})
    EXPECT_LT(estimateUnit(scaled(litres), 2.3e-3).confidence, 0.6) << litres;
  EXPECT_EQ(estimateUnit(scaled(0.2), 2.3e-3).confidence, 1);
  // 0.15 L in centimetres are 2.5 L in inches
  SurfaceMesh sleeve = scaled(0.15);
  for (auto& v : sleeve.vertices) v *= 100;
  EXPECT_NE(estimateUnit(sleeve, 2.3e-3).doubt.find("as well"), std::string::npos);
  EXPECT_NE(estimateUnit(scaled(0.9), 30e-3).doubt.find("its wall, as thick as in the scene, weighs"),
            std::string::npos);
  SizeEstimate estimate{{"m", 1}, 1, ""};
  addLengthMark(0.3, estimate);
  EXPECT_EQ(estimate.confidence, 1);
  addLengthMark(0.8, estimate);
  EXPECT_LT(estimate.confidence, 0.6);
  EXPECT_EQ(estimate.doubt, "its axis is 800 mm long, and that of stomachs 120 to 500 mm");
}

TEST_F(MeshGuess, StatedLandmarksAreNotGuessed) {
  const Organ original = stomach();
  write(original.surface);
  Scene scene;
  scene.geometry.unit = 1e-3;
  scene.geometry.oesophagus = scene.geometry.fundus = scene.geometry.incisura = scene.geometry.pylorus =
      Eigen::Vector3d(1, 2, 3);
  EXPECT_EQ(useMesh(scene, file), "");
  EXPECT_FALSE(scene.geometry.landmark_confidence);
  EXPECT_EQ(landmarkRemark(scene), "");
  EXPECT_EQ(*scene.geometry.fundus, Eigen::Vector3d(1, 2, 3));
}

TEST_F(MeshGuess, WarnsOfADoubtfulGuessInOneSentence) {
  SurfaceMesh tilted = stomach().surface;  // by 40 degrees to the side
  for (auto& v : tilted.vertices) v = Eigen::AngleAxisd(-40 * M_PI / 180, Eigen::Vector3d::UnitY()) * v;
  write(tilted);
  Scene scene;
  const std::string remark = useMesh(scene, file);
  EXPECT_NE(remark.find("are doubtful: its bend does not lie in the frontal plane; state them"), std::string::npos)
      << remark;
  EXPECT_LT(scene.geometry.landmark_confidence.value_or(1), 0.6);
}

TEST_F(MeshGuess, ASurfaceWithoutLandmarksIsAnError) {
  Scene sphere;
  sphere.geometry.kind = GeometryScene::Kind::Sphere;
  sphere.geometry.particles = 1000;
  for (const double length : {1.0, 3.0}) {  // a ball, a tube
    SurfaceMesh mesh = buildOrgan(sphere).surface;
    for (auto& v : mesh.vertices) v.z() *= length;
    write(mesh);
    Scene scene;
    try {
      useMesh(scene, file);
      ADD_FAILURE() << "no error";
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("is not like a stomach"), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find(file + ".landmarks.yaml"), std::string::npos) << error.what();
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
    EXPECT_EQ(scene.geometry.kind, GeometryScene::Kind::Stomach) << "the scene is as it was";
  }
}

TEST_F(MeshGuess, SaysWhatIsWrongWithTheFile) {
  Scene scene;
  EXPECT_THROW(useMesh(scene, file + ".missing.obj"), Error);
  std::ofstream(file) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  EXPECT_THROW(useMesh(scene, file), Error);
}

}  // namespace
}  // namespace vibe::mesh_guess_test
