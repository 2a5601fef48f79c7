#include "vibe_core/scene/scene_parser.hpp"

#include <gtest/gtest.h>

#include <string>

#include "vibe_testing/expect_error.hpp"
#include "vibe_testing/temporary_folder.hpp"

namespace vibe::mesh_override_test {
namespace {

class MeshOverride : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) const { return folder_.write(name, text); }

  test::TemporaryFolder folder_;
  Scene scene_ = parseScene("name: s\ngeometry: {particles: 900}\ngas: {}\n", "s.yaml");
};

const char* const kLandmarks =
    "landmarks: {oesophagus: [1, 2, 3], fundus: [4, 5, 6], incisura: [7, 8, 9], pylorus: [10, 11, 12]}\n";

TEST_F(MeshOverride, SidecarTellsAll) {
  const std::string mesh = write("a.obj", "");
  write("a.obj.landmarks.yaml",
        std::string("unit: 1 mm\nrotation_rpy: [0, 0, 90 deg]\ntarget_volume: 0.5 L\n") + kLandmarks);
  EXPECT_TRUE(applyMeshOverride(scene_, mesh));
  EXPECT_EQ(scene_.geometry.kind, GeometryScene::Kind::Mesh);
  EXPECT_EQ(scene_.geometry.file, mesh);
  EXPECT_EQ(scene_.geometry.particles, 900);  // stays as the scene says
  EXPECT_TRUE(scene_.gas);
  EXPECT_DOUBLE_EQ(scene_.geometry.unit, 1e-3);
  EXPECT_DOUBLE_EQ(scene_.geometry.target_volume, 0.5e-3);
  EXPECT_DOUBLE_EQ(scene_.geometry.rotation_rpy[2], 1.5707963267948966);
  EXPECT_EQ(*scene_.geometry.pylorus, Eigen::Vector3d(10, 11, 12));
}

TEST_F(MeshOverride, SceneTellsWhatTheSidecarDoesNot) {
  const std::string mesh = write("a.obj", "");
  Scene scene = parseScene(std::string("geometry: {kind: mesh, file: other.obj, unit: 1 cm, ") +
                               std::string(kLandmarks).substr(0, std::string(kLandmarks).size() - 1) + "}",
                           "s.yaml");
  EXPECT_FALSE(applyMeshOverride(scene, mesh));
  EXPECT_EQ(scene.geometry.file, mesh);
  EXPECT_DOUBLE_EQ(scene.geometry.unit, 0.01);
  write("a.obj.landmarks.yaml", "unit: 1 mm\nlandmarks: {fundus: [0, 0, 1]}\n");
  EXPECT_TRUE(applyMeshOverride(scene, mesh));
  EXPECT_DOUBLE_EQ(scene.geometry.unit, 1e-3);
  EXPECT_EQ(*scene.geometry.fundus, Eigen::Vector3d(0, 0, 1));
  EXPECT_EQ(*scene.geometry.pylorus, Eigen::Vector3d(10, 11, 12));
}

TEST_F(MeshOverride, SaysExactlyWhatIsMissing) {
  EXPECT_ERROR(applyMeshOverride(scene_, folder_.path() + "/none.obj"), "none.obj: there is no such surface file");
  const std::string mesh = write("a.stl", "");
  const std::string message = errorOf([&] { applyMeshOverride(scene_, mesh); });
  for (const char* part :
       {"a.stl:", "its unit", "'unit: 1 mm'", "oesophagus: [x, y, z]", "pylorus", "a.stl.landmarks.yaml"}) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  }
  write("a.stl.landmarks.yaml",
        "unit: 1 mm\nlandmarks: {oesophagus: [1, 2, 3], fundus: [4, 5, 6], pylorus: [7, 8, 9]}\n");
  const std::string rest = errorOf([&] { applyMeshOverride(scene_, mesh); });
  EXPECT_NE(rest.find("'landmarks: {incisura: [x, y, z]}'"), std::string::npos) << rest;
  EXPECT_EQ(rest.find("unit: 1 mm"), std::string::npos) << rest;
  EXPECT_EQ(scene_.geometry.kind, GeometryScene::Kind::Stomach);  // a failure leaves the scene as it was
}

TEST_F(MeshOverride, GltfNeedsNoUnit) {
  const std::string mesh = write("a.GLB", "");
  write("a.GLB.landmarks.yaml", kLandmarks);
  EXPECT_TRUE(applyMeshOverride(scene_, mesh));
  EXPECT_EQ(scene_.geometry.unit, 0);
}

TEST_F(MeshOverride, TargetVolumeNeedsNoUnit) {
  const std::string mesh = write("a.obj", "");
  write("a.obj.landmarks.yaml", std::string("target_volume: 1 L\n") + kLandmarks);
  EXPECT_TRUE(applyMeshOverride(scene_, mesh));
}

TEST_F(MeshOverride, SidecarIsCheckedLikeAScene) {
  const std::string mesh = write("a.obj", "");
  const std::string place = folder_.path() + "/a.obj.landmarks.yaml:";
  write("a.obj.landmarks.yaml", "units: 1 mm\n");
  EXPECT_ERROR(applyMeshOverride(scene_, mesh), place + "1: units: is not a known key; did you mean 'unit'?");
  write("a.obj.landmarks.yaml", "unit: 1 mm\nlandmarks:\n  pilorus: [1, 2, 3]\n");
  EXPECT_ERROR(applyMeshOverride(scene_, mesh),
               place + "3: landmarks.pilorus: is not a known key; did you mean 'pylorus'?");
  write("a.obj.landmarks.yaml", "unit: 1 kg\n");
  EXPECT_ERROR(applyMeshOverride(scene_, mesh), place + "1: unit: '1 kg' is a mass");
}

}  // namespace
}  // namespace vibe::mesh_override_test
