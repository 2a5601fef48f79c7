#include "builder/mesh_import.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <random>
#include <string>

#include "geometry/mesh_writer.hpp"
#include "geometry/surface_check.hpp"
#include "geometry/test_surfaces.hpp"
#include "vibe_core/builder/model_builder.hpp"
#include "vibe_core/geometry/mesh_file.hpp"
#include "vibe_core/geometry/triangle_tree.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::mesh_import_test {
namespace {

using test::makeBox;
using test::makeTorus;
using test::makeUvSphere;
using test::TemporaryFolder;

struct Format {
  const char* name;
  std::function<std::string(const SurfaceMesh&)> write;
};

const std::array<Format, 4>& formats() {
  static const std::array<Format, 4> all{{{"mesh.obj", test::toObj},
                                          {"mesh.ply", test::toPly},
                                          {"mesh.stl", test::toStl},
                                          {"mesh.glb", [](const SurfaceMesh& m) { return test::toGlb(m); }}}};
  return all;
}

/// An egg of 200 mm in millimetres with landmarks on it: a crude stomach.
SurfaceMesh makeEgg() {
  SurfaceMesh mesh = makeUvSphere(50, 14, 22);
  for (auto& v : mesh.vertices) v = Eigen::Vector3d(v.x(), v.y(), 2 * v.z()) + Eigen::Vector3d(300, -200, 1000);
  return mesh;
}

GeometryScene eggScene(const std::string& file) {
  GeometryScene geometry;
  geometry.kind = GeometryScene::Kind::Mesh;
  geometry.file = file;
  geometry.unit = 1e-3;
  geometry.particles = 600;
  geometry.oesophagus = Eigen::Vector3d(300, -240, 1060);
  geometry.fundus = Eigen::Vector3d(300, -200, 1100);
  geometry.incisura = Eigen::Vector3d(300, -243, 960);
  geometry.pylorus = Eigen::Vector3d(300, -200, 900);
  return geometry;
}

std::string refusal(const GeometryScene& geometry) {
  try {
    importMesh(geometry);
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

void expectRejected(const GeometryScene& geometry, const std::string& because) {
  const std::string message = refusal(geometry);
  EXPECT_NE(message.find(because), std::string::npos) << "expected: " << because << "\nmessage:  " << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

TEST(MeshImport, readsTheSameSurfaceFromEveryFormat) {
  const TemporaryFolder folder;
  const SurfaceMesh egg = makeEgg();
  for (const auto& format : formats()) {
    const SurfaceMesh mesh = readMeshFile(folder.write(format.name, format.write(egg)));
    EXPECT_EQ(mesh.vertices.size(), egg.vertices.size()) << format.name;
    EXPECT_EQ(mesh.triangles.size(), egg.triangles.size()) << format.name;
    EXPECT_NEAR(enclosedVolume(mesh) / enclosedVolume(egg), 1, 1e-5) << format.name;
    EXPECT_NO_THROW(checkSurface(mesh, format.name));
  }
}

TEST(MeshImport, appliesTheTransformOfTheNode) {
  const TemporaryFolder folder;
  const std::string turned = "0,2,0,0, -2,0,0,0, 0,0,2,0, 5,6,7,1";  // doubled, turned about z, moved
  const SurfaceMesh mesh = readMeshFile(folder.write("mesh.glb", test::toGlb(makeBox(0.1, 0.2, 0.3), turned)));
  Eigen::AlignedBox3d box;
  for (const auto& v : mesh.vertices) box.extend(v);
  EXPECT_LT((box.sizes() - Eigen::Vector3d(0.4, 0.2, 0.6)).norm(), 1e-6);
  EXPECT_LT((box.center() - Eigen::Vector3d(5, 6, 7)).norm(), 1e-6);
}

TEST(MeshImport, appliesUnitAndRotationToSurfaceAndLandmarks) {
  const TemporaryFolder folder;
  GeometryScene geometry = eggScene(folder.write("mesh.obj", test::toObj(makeEgg())));
  geometry.rotation_rpy = {0, 0, M_PI / 2};
  const ImportedMesh imported = importMesh(geometry);
  EXPECT_NEAR(enclosedVolume(imported.surface), 1e-9 * enclosedVolume(makeEgg()), 1e-9);
  EXPECT_LT((imported.landmarks.fundus - Eigen::Vector3d(0.2, 0.3, 1.1)).norm(), 1e-12);
  double highest = 0;
  for (const auto& v : imported.surface.vertices) highest = std::max(highest, v.z());
  EXPECT_NEAR(highest, 1.1, 1e-6);
}

TEST(MeshImport, rotationIsAboutFixedAxesInTheOrderRollPitchYaw) {
  const TemporaryFolder folder;
  GeometryScene geometry = eggScene(folder.write("mesh.obj", test::toObj(makeEgg())));
  geometry.rotation_rpy = {M_PI / 2, 0, M_PI / 2};  // (x, y, z) -> (z, x, y)
  EXPECT_LT((importMesh(geometry).landmarks.fundus - Eigen::Vector3d(1.1, 0.3, -0.2)).norm(), 1e-12);
}

TEST(MeshImport, takesTheAxesThatSlicerStates) {
  const TemporaryFolder folder;
  const std::string obj = test::toObj(makeEgg()), stl = test::toStl(makeEgg()), ply = test::toPly(makeEgg());
  const auto named = [&](const std::string& space) {
    std::string header = stl, comment = ply;
    header.replace(0, 27, "3D Slicer output. SPACE=" + space);
    comment.insert(comment.find("element"), "comment 3D Slicer output. SPACE=" + space + "\n");
    return std::array<std::string, 3>{folder.write("a.obj", "# 3D Slicer output. SPACE=" + space + "\n" + obj),
                                      folder.write("a.stl", header), folder.write("a.ply", comment)};
  };
  for (const std::string& file : named("LPS"))
    EXPECT_LT((importMesh(eggScene(file)).landmarks.fundus - Eigen::Vector3d(0.2, 0.3, 1.1)).norm(), 1e-12) << file;
  for (const std::string& file : named("RAS")) {
    EXPECT_LT((importMesh(eggScene(file)).landmarks.fundus - Eigen::Vector3d(-0.2, -0.3, 1.1)).norm(), 1e-12) << file;
    GeometryScene geometry = eggScene(file);
    geometry.rotation_rpy = {0, 0, M_PI};  // stated axes take precedence
    EXPECT_LT((importMesh(geometry).landmarks.fundus - Eigen::Vector3d(-0.3, 0.2, 1.1)).norm(), 1e-12) << file;
  }
  EXPECT_FALSE(statedAxes(folder.write("plain.obj", obj + "# SPACE=none\no SPACE=RAS\n")));
}

TEST(MeshImport, targetVolumeSetsTheSizeWhateverTheUnit) {
  const TemporaryFolder folder;
  GeometryScene geometry = eggScene(folder.write("mesh.stl", test::toStl(makeEgg())));
  geometry.target_volume = 0.9e-3;
  geometry.unit = 0;
  const ImportedMesh imported = importMesh(geometry);
  EXPECT_NEAR(enclosedVolume(imported.surface), 0.9e-3, 1e-12);
  const double factor = std::cbrt(0.9e-3 / enclosedVolume(makeEgg()));
  EXPECT_NEAR(imported.landmarks.pylorus.z(), 900 * factor, 1e-6);
}

TEST(MeshImport, turnsAnInsideOutFile) {
  const TemporaryFolder folder;
  SurfaceMesh egg = makeEgg();
  for (auto& t : egg.triangles) std::swap(t[0], t[1]);
  EXPECT_GT(enclosedVolume(importMesh(eggScene(folder.write("mesh.obj", test::toObj(egg)))).surface), 0);
}

TEST(MeshImport, asksForTheUnitAndNamesTheLikelyOne) {
  const TemporaryFolder folder;
  GeometryScene geometry = eggScene(folder.write("mesh.obj", test::toObj(makeEgg())));
  geometry.unit = 0;
  expectRejected(geometry, "geometry.unit is missing");
  expectRejected(geometry, "perhaps 'unit: 1 mm', with which it is 0.2 m large");
  geometry.file = folder.write("mesh.glb", test::toGlb(makeEgg()));
  expectRejected(geometry, "is 200 units large");
  expectRejected(geometry, "perhaps 'unit: 1 mm'");
  geometry.unit = 1000;
  expectRejected(geometry, "which with a unit of 1000 m is no organ of 0.05 to 1 m");
  geometry.unit = -1;
  expectRejected(geometry, "no organ of 0.05 to 1 m");
}

TEST(MeshImport, takesGltfInMetres) {
  const TemporaryFolder folder;
  SurfaceMesh egg = makeEgg();
  for (auto& v : egg.vertices) v *= 1e-3;
  GeometryScene geometry = eggScene(folder.write("mesh.glb", test::toGlb(egg)));
  geometry.unit = 0;
  EXPECT_EQ(refusal(geometry), "");
}

TEST(MeshImport, namesTheMissingLandmarks) {
  const TemporaryFolder folder;
  GeometryScene geometry = eggScene(folder.write("mesh.obj", test::toObj(makeEgg())));
  geometry.fundus.reset();
  geometry.pylorus.reset();
  expectRejected(geometry, "missing: geometry.fundus, geometry.pylorus;");
}

TEST(MeshImport, refusesTwoLandmarksInOnePlace) {
  const TemporaryFolder folder;
  GeometryScene geometry = eggScene(folder.write("mesh.obj", test::toObj(makeEgg())));
  geometry.fundus = geometry.oesophagus;
  expectRejected(geometry, "The landmarks 'oesophagus' and 'fundus' are 0 mm apart");
}

TEST(MeshImport, saysWhatIsWrongWithTheFile) {
  const TemporaryFolder folder;
  expectRejected(eggScene(""), "geometry.file is missing");
  expectRejected(eggScene(folder.path() + "/none.obj"), "does not exist");
  expectRejected(eggScene(folder.path()), "cannot be read");
  expectRejected(eggScene(folder.write("mesh.txt", "hello")), "not of a type");
  expectRejected(eggScene(folder.write("empty.obj", "")), "is empty");
  expectRejected(eggScene(folder.write("cut.gltf", "{\"asset\": {\"version\"")), "ends within its JSON");
  expectRejected(eggScene(folder.write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n")), "has no faces");
  expectRejected(eggScene(folder.write("named.obj", test::toPly(makeEgg()))), "begins like a file of the type .ply");
  expectRejected(eggScene(folder.write("ring.obj", test::toObj(makeTorus(50, 20, 20, 10)))), "1 handle");
}

/// A tetrahedron as glTF whose numbers are in another file.
std::string toGltf(const std::string& uri) {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
         R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],"buffers":[{"byteLength":72,"uri":")" +
         uri +
         R"("}],"bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":24}],)"
         R"("accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},)"
         R"({"bufferView":1,"componentType":5123,"count":12,"type":"SCALAR"}]})";
}

TEST(MeshImport, readsWhatAGltfNamesInItsFolderOnly) {
  const TemporaryFolder folder;
  std::string numbers;
  for (const int x : {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}) test::append(numbers, static_cast<float>(x));
  for (const int v : {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2}) test::append(numbers, static_cast<std::uint16_t>(v));
  folder.write("numbers.bin", numbers);
  EXPECT_EQ(readMeshFile(folder.write("tetra.gltf", toGltf("numbers.bin"))).triangles.size(), 4U);
  std::filesystem::create_directory(folder.path() + "/below");
  expectRejected(eggScene(folder.write("below/tetra.gltf", toGltf("../numbers.bin"))), "which is not in its folder");
  expectRejected(eggScene(folder.write("below/tetra.gltf", toGltf("/etc/hostname"))), "which is not in its folder");
}

TEST(MeshImport, buildsAnOrganWithLabels) {
  const TemporaryFolder folder;
  Scene scene;
  scene.geometry = eggScene(folder.write("mesh.ply", test::toPly(makeEgg())));
  const Organ organ = buildOrgan(scene);
  EXPECT_EQ(organ.surface.vertices.size(), 600u);
  EXPECT_NEAR(enclosedVolume(organ.surface) / (1e-9 * enclosedVolume(makeEgg())), 1, 1e-6);
  for (int r = 0; r < kRegionCount; ++r) {
    EXPECT_GT(std::count(organ.region.begin(), organ.region.end(), static_cast<Region>(r)), 0) << r;
  }
  const TriangleTree tree(organ.surface);
  for (double way = 0.01; way < 0.1; way += 0.005) {  // a scope goes straight in
    EXPECT_GT(tree.closest(organ.entry + way * organ.entry_axis).distance, 5e-3);
    EXPECT_LT(tree.firstHit(organ.entry + way * organ.entry_axis, Eigen::Vector3d::UnitX()), 0.1);  // inside
  }
  EXPECT_NEAR(organ.entry_axis.norm(), 1, 1e-12);
  EXPECT_GT(std::count(organ.end.begin(), organ.end.end(), End::Oesophagus), 0);
  EXPECT_GT(std::count(organ.end.begin(), organ.end.end(), End::Duodenum), 0);
}

TEST(MeshImport, findsTheFileBesideTheScene) {
  const TemporaryFolder folder;
  folder.write("mesh.obj", test::toObj(makeEgg()));
  Scene scene;
  scene.file = folder.path() + "/scene.yaml";
  scene.geometry = eggScene("mesh.obj");
  scene.geometry.particles = 200;
  EXPECT_NO_THROW(buildOrgan(scene));
}

TEST(MeshImport, refusesLandmarksFarFromTheSurface) {
  const TemporaryFolder folder;
  Scene scene;
  scene.geometry = eggScene(folder.write("mesh.obj", test::toObj(makeEgg())));
  scene.geometry.incisura = Eigen::Vector3d(0, 0, 0);
  EXPECT_THROW(buildOrgan(scene), Error);
}

/// Import must end in a surface or an Error, whatever the bytes; nothing else may come out.
bool survives(const GeometryScene& geometry, std::string& message) {
  try {
    importMesh(geometry);
    return true;
  } catch (const Error& e) {
    message = e.what();
    return !message.empty() && message.find('\n') == std::string::npos;
  } catch (...) {
    message = "another exception";
    return false;
  }
}

TEST(MeshImportFuzz, truncatedFilesEndInAnErrorOrASurface) {
  const TemporaryFolder folder;
  for (const auto& format : formats()) {
    const std::string whole = format.write(makeEgg());
    int refused = 0;
    for (int k = 1; k < 40; ++k) {
      const std::string file = folder.write(format.name, whole.substr(0, whole.size() * k / 40));
      std::string message;
      EXPECT_TRUE(survives(eggScene(file), message)) << format.name << " cut at " << k << "/40: " << message;
      refused += message.empty() ? 0 : 1;
    }
    EXPECT_EQ(refused, 39) << format.name;
  }
}

TEST(MeshImportFuzz, garbledFilesEndInAnErrorOrASurface) {
  const TemporaryFolder folder;
  std::mt19937 random(7);
  for (const auto& format : formats()) {
    const std::string whole = format.write(makeUvSphere(50, 5, 6));
    for (int k = 0; k < 250; ++k) {
      std::string bytes = whole;
      for (int n = 1 + static_cast<int>(random() % 8); n > 0; --n) {
        // half of the damage goes to the header, where sizes and types are
        const std::size_t reach = random() % 2 == 0 ? std::min<std::size_t>(bytes.size(), 200) : bytes.size();
        bytes[random() % reach] = static_cast<char>(random() % 256);
      }
      std::string message;
      EXPECT_TRUE(survives(eggScene(folder.write(format.name, bytes)), message))
          << format.name << " case " << k << ": " << message;
    }
  }
}

}  // namespace
}  // namespace vibe::mesh_import_test
