#include "vibe_core/scene/scene_parser.hpp"
#include "vibe_core/suture/suture_thread.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "vibe_testing/expect_error.hpp"

namespace vibe::scene_parser_test {
namespace {

const std::string kScenes = std::string(VIBE_CORE_DIR) + "/scenes/";

Scene parsed(const std::string& yaml) {
  return parseScene(yaml, "dir/s.yaml");
}

std::string contents(const std::string& file) {
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

TEST(ShippedScenes, StomachHasEveryPart) {
  const Scene scene = loadScene(kScenes + "stomach.yaml");
  EXPECT_EQ(scene.file, kScenes + "stomach.yaml");
  EXPECT_EQ(scene.name, "stomach");
  EXPECT_EQ(scene.step_period, 1.0 / 60);
  EXPECT_EQ(scene.geometry.kind, GeometryScene::Kind::Stomach);
  EXPECT_EQ(scene.geometry.particles, 3618);
  EXPECT_DOUBLE_EQ(scene.geometry.volume, 0.9e-3);
  EXPECT_DOUBLE_EQ(scene.tissue.density, 1050);
  EXPECT_DOUBLE_EQ(scene.tissue.thickness[static_cast<int>(Region::Body)], 2.33e-3);
  EXPECT_TRUE(scene.attach_oesophagus && scene.attach_duodenum && scene.render_surface);
  ASSERT_TRUE(scene.gas && scene.gravity && scene.foundation && scene.scope && scene.helix && scene.suture &&
              scene.bleeding);
  EXPECT_NEAR(scene.gas->regulated_pressure, 1333.224, 1e-3);
  EXPECT_DOUBLE_EQ(scene.gas->flow_limit, 5e-5);
  EXPECT_TRUE(scene.scope->base_from_anatomy);
}

TEST(ShippedScenes, MinimalHasNothingElse) {
  const Scene scene = loadScene(kScenes + "stomach_minimal.yaml");
  EXPECT_FALSE(scene.gas || scene.gravity || scene.foundation || scene.scope || scene.helix || scene.suture ||
               scene.bleeding);
  EXPECT_FALSE(scene.attach_oesophagus || scene.attach_duodenum || scene.render_surface);
}

TEST(ShippedScenes, SphereIsSmall) {
  const Scene scene = loadScene(kScenes + "sphere.yaml");
  EXPECT_EQ(scene.geometry.kind, GeometryScene::Kind::Sphere);
  EXPECT_EQ(scene.geometry.particles, 642);
  EXPECT_TRUE(scene.gas && scene.gas->insufflator_on);
}

TEST(ShippedScenes, ImportedMeshSaysThatTheFileIsUpToTheUser) {
  const std::string file = kScenes + "imported_mesh.yaml";
  EXPECT_ERROR(loadScene(file), "geometry.file: there is no file '" + kScenes + "my_stomach.obj'; give the path");
  const Scene scene = parseScene(contents(file), file);  // all else is right
  EXPECT_DOUBLE_EQ(scene.geometry.unit, 1e-3);
  ASSERT_TRUE(scene.geometry.pylorus);
  EXPECT_EQ(*scene.geometry.pylorus, Eigen::Vector3d(20, -30, 30));
}

TEST(SceneBase, OverridesWhatItNamesAndKeepsTheRest) {
  const Scene base = loadScene(kScenes + "stomach.yaml");
  const auto with = [](const std::string& yaml) { return parseScene(yaml, kScenes + "s.yaml"); };
  Scene scene = with("base: stomach.yaml\ngas: {regulated_pressure: 8 mmHg}\nscope: {friction: 0.2}\n");
  EXPECT_NEAR(scene.gas->regulated_pressure, 1066.579, 1e-3);
  EXPECT_EQ(scene.gas->flow_limit, base.gas->flow_limit);
  EXPECT_EQ(scene.scope->friction, 0.2);
  EXPECT_EQ(scene.file, kScenes + "s.yaml");
  EXPECT_EQ(scene.scope->urdf, base.scope->urdf);
  scene.gas = base.gas, scene.scope->friction = base.scope->friction;
  EXPECT_EQ(toYaml(scene), toYaml(base));
  // a section of the base satisfies what another one needs, whatever the order
  EXPECT_TRUE(with("marking: {power: 20}\nbase: sphere.yaml\nscope: {}\n").marking);
  EXPECT_ERROR(with("marking: {power: 20}\nbase: sphere.yaml\n"), "needs the section 'scope'");
  EXPECT_ERROR(with("base: stomach.yaml\nsuture: {loose_tension: 4}\n"), "suture.loose_tension: is 4 N");
  EXPECT_ERROR(with("base: none.yaml\n"), "base: there is no file");
  // a section that is 'none' is not there
  scene = with("base: stomach.yaml\ngas: none\nbleeding: none\nscope: {compliance: none, base: none}\n");
  EXPECT_FALSE(scene.gas || scene.bleeding || scene.scope->compliance);
  EXPECT_TRUE(scene.gravity && scene.suture && scene.scope->base_from_anatomy);
  EXPECT_ERROR(with("base: stomach.yaml\nhelix: none\n"), "s.yaml:2: helix: is what 'suture' needs, which brings");
  EXPECT_FALSE(with("base: stomach.yaml\nhelix: none\nsuture: none\nbleeding: none\n").helix);
  EXPECT_ERROR(with("base: stomach.yaml\ntissue: none\n"), "tissue: is in every scene");
  EXPECT_ERROR(with("name: x\nbase: package://vibe_cor/s.yaml\n"), "s.yaml:2: base: There is no package 'vibe_cor'");
  EXPECT_ERROR(with("basee: stomach.yaml\n"), "did you mean 'base'");
  EXPECT_ERROR(with("gas: {base: stomach.yaml}\n"), "gas.base: is not");
  EXPECT_EQ(toYaml(with("base: package://vibe_core/scenes/stomach.yaml\n")), toYaml(base));
}

TEST(SceneParser, AMeshIsFoundFromAnyWorkingDirectory) {
  const std::string folder = ::testing::TempDir() + "scene_mesh_test/";
  std::filesystem::create_directories(folder + "scenes");
  std::ofstream(folder + "m.obj") << "v 0 0 0\n";
  std::ofstream(folder + "scenes/s.yaml")
      << "geometry: {kind: mesh, file: ../m.obj, unit: 1 mm, landmarks: {oesophagus: [0, 0, 0], fundus: [0, 0, 0], "
         "incisura: [0, 0, 0], pylorus: [0, 0, 0]}}\n";
  const Scene scene = loadScene(std::filesystem::relative(folder + "scenes/s.yaml").string());
  EXPECT_TRUE(std::filesystem::path(scene.geometry.file).is_absolute()) << scene.geometry.file;
  EXPECT_TRUE(std::filesystem::is_regular_file(scene.geometry.file)) << scene.geometry.file;
  std::filesystem::remove_all(folder);
}

TEST(SceneBase, ACircleIsAnError) {
  const std::string file = ::testing::TempDir() + "scene_base_test.yaml";
  std::ofstream(file) << "base: scene_base_test.yaml\n";
  EXPECT_ERROR(loadScene(file), "more than 8 times, perhaps in a circle");
  std::filesystem::remove(file);
}

TEST(SceneParser, SectionsArePresentOnlyIfNamed) {
  for (const std::string& empty : {std::string("gas:\n"), std::string("gas: {}\n"), std::string("gas: ~\n")}) {
    const Scene scene = parsed(empty);
    ASSERT_TRUE(scene.gas) << empty;
    EXPECT_EQ(scene.gas->regulated_pressure, GasScene{}.regulated_pressure);
    EXPECT_FALSE(scene.foundation);
  }
}

TEST(SceneParser, BasePoseReplacesAnatomy) {
  const Scene scene = parsed("scope: {base: {position: [1 cm, 0, -2], rpy: [0, 90 deg, 0]}}");
  EXPECT_FALSE(scene.scope->base_from_anatomy);
  EXPECT_DOUBLE_EQ(scene.scope->base_position.x(), 0.01);
  EXPECT_DOUBLE_EQ(scene.scope->base_rpy[1], 1.5707963267948966);
  EXPECT_ERROR(parsed("scope: {base: {rpy: [0, 0, 0]}}"), "dir/s.yaml:1: scope.base: lacks the key 'position'");
}

TEST(SceneParser, UnknownKeysNameTheNearest) {
  EXPECT_ERROR(parsed("name: x\ntissue:\n  yung_modulus: 1\n"),
               "dir/s.yaml:3: tissue.yung_modulus: is not a known key; did you mean 'young_modulus'?");
  EXPECT_ERROR(parsed("gass: {}"), "did you mean 'gas'?");
  EXPECT_ERROR(parsed("regulated_pressure: 3"), "is not known here; write it as 'gas.regulated_pressure'");
  EXPECT_ERROR(parsed("tissue: {colour: red}"), "known are model, law");
}

TEST(SceneParser, KeysHaveNoDots) {
  EXPECT_ERROR(parsed("scope.friction: 0.1"),
               "s.yaml:1: scope.friction: has a dot in it; write 'friction' in the section");
  EXPECT_ERROR(parsed("scope.compliance: {}"), "write 'compliance' in the section 'scope'");
}

TEST(SceneParser, KeysOfOtherKindsDoNotApply) {
  EXPECT_ERROR(parsed("geometry:\n  radius: 5 cm\n"),
               "dir/s.yaml:2: geometry.radius: does not apply to geometry.kind "
               "'stomach'; remove it or write 'kind: sphere'");
  EXPECT_ERROR(parsed("geometry: {kind: sphere, volume: 1 L}"), "write 'kind: stomach'");
  EXPECT_ERROR(parsed("geometry: {file: a.obj}"), "write 'kind: mesh'");
  EXPECT_ERROR(parsed("geometry: {landmarks: {}}"), "geometry.landmarks: does not apply");
}

TEST(SceneParser, PartsThatNeedEachOther) {
  EXPECT_ERROR(parsed("name: x\nhelix: {}"), "dir/s.yaml:2: helix: needs the section 'scope'");
  EXPECT_ERROR(parsed("scope: {}\nsuture: {}"), "dir/s.yaml:2: suture: needs the section 'helix'");
  EXPECT_ERROR(parsed("scope: {}\nhelix: {}\nbleeding: {}"), "dir/s.yaml:3: bleeding: needs the section 'suture'");
  EXPECT_ERROR(parsed("name: x\nmarking: {}"), "dir/s.yaml:2: marking: needs the section 'scope'");
  EXPECT_EQ(errorOf([] { parsed("bleeding: {}\nsuture: {}\nhelix: {}\nscope: {}"); }), "no error");
  EXPECT_ERROR(parsed("geometry: {kind: mesh}"), "geometry: lacks the key 'file'");
  EXPECT_ERROR(parsed("geometry: {kind: mesh, file: a.obj, landmarks: {pylorus: [1, 2, 3]}}"),
               "lacks the key 'oesophagus'");
  EXPECT_EQ(errorOf([] { parsed("scope: {}\nhelix: {}"); }), "no error");
}

TEST(SceneParser, MarkingHasUnitsAndItsEnergiesAnOrder) {
  const Scene scene = parsed("scope: {}\nmarking: {power: 20 W, argon_flow: 1.2 L/min, burn_energy: 0.6 kJ}");
  ASSERT_TRUE(scene.marking);
  EXPECT_DOUBLE_EQ(scene.marking->apc.power, 20);
  EXPECT_DOUBLE_EQ(scene.marking->apc.argon_flow, 2e-5);
  EXPECT_DOUBLE_EQ(scene.marking->apc.burn_energy, 600);
  EXPECT_EQ(scene.marking->deformation, "solver");
  EXPECT_ERROR(parsed("scope: {}\nmarking: {mark_energy: 500}"),
               "marking.mark_energy: is 500 J, but marking.burn_energy");
  EXPECT_ERROR(parsed("scope: {}\nmarking: {burn_energy: 900}"),
               "marking.burn_energy: is 900 J, but marking.deep_energy");
  EXPECT_ERROR(parsed("scope: {}\nmarking: {deep_energy: 400}"),
               "marking.deep_energy: is 400 J, but marking.burn_energy");
  EXPECT_ERROR(parsed("scope: {}\nmarking: {deformation: shell}"), "solver");
}

/// The scene has rounded figures of the material whose source is told there.
TEST(SceneParser, TheThreadIsThatOfItsSource) {
  const ThreadMaterial material = polypropylene20();
  EXPECT_NEAR(SutureScene{}.thread_stiffness, material.axialStiffness(), 0.5);
  EXPECT_EQ(SutureScene{}.thread_friction, material.tissue_friction);
  EXPECT_NEAR(SutureScene{}.thread_strength, material.breaking_force, 0.05);
}

Scene withSuture(const std::string& suture, const std::string& bleeding = "") {
  return parsed("scope: {}\nhelix: {}\nsuture: {" + suture + "}\nbleeding: {" + bleeding + "}");
}

TEST(SceneParser, SutureWordsNameTheNearest) {
  EXPECT_EQ(withSuture("cinch_model: thread, classifier: printed").suture->classifier, "printed");
  EXPECT_ERROR(withSuture("cinch_model: tread"),
               "dir/s.yaml:3: suture.cinch_model: 'tread' is not known here; did you mean "
               "'thread'?");
  EXPECT_ERROR(withSuture("classifier: paper"), "known are corrected, printed");
}

TEST(SceneParser, SutureValuesThatAreAtOddsNameTheOneThatIsWritten) {
  EXPECT_ERROR(withSuture("min_bites: 9, max_bites: 8"),
               "dir/s.yaml:3: suture.min_bites: is 9, but suture.max_bites is 8; write at most that");
  EXPECT_ERROR(withSuture("cinch_tension: 20 N"),
               "suture.cinch_tension: is 20 N, but suture.thread_strength is 14.1 N");
  EXPECT_ERROR(withSuture("thread_strength: 2 N"),
               "suture.thread_strength: is 2 N, but suture.cinch_tension is 3 N; write at least that");
  EXPECT_ERROR(withSuture("loose_tension: 4 N"), "suture.loose_tension: is 4 N, but suture.cinch_tension is 3 N");
  EXPECT_ERROR(withSuture("loose_tension: 3 N"), "suture.loose_tension: leaves every cinch loose");
  EXPECT_ERROR(withSuture("", "brisk_probability: 0.9"), "dir/s.yaml:4: bleeding.brisk_probability: is too much");
  EXPECT_EQ(errorOf([] { withSuture("min_bites: 8, max_bites: 8, cinch_tension: 14.1", "brisk_probability: 0.75"); }),
            "no error");
}

TEST(SceneParser, PathsAreRelativeToTheFile) {
  EXPECT_EQ(parsed("geometry: {kind: mesh, file: ../a.obj}").geometry.file, "a.obj");
  EXPECT_EQ(parsed("geometry: {kind: mesh, file: /x/a.obj}").geometry.file, "/x/a.obj");
  EXPECT_EQ(parsed("scope: {urdf: tool.urdf}").scope->urdf, "dir/tool.urdf");
  EXPECT_EQ(parsed("scope: {}").scope->urdf, ScopeScene{}.urdf);
  EXPECT_ERROR(loadScene("/nowhere.yaml"), "/nowhere.yaml: cannot be opened");
}

TEST(SceneParser, SharesValuesThroughAliasesAndMerges) {
  const Scene scene = parsed("tissue:\n  thickness: {fundus: &thin 1.5 mm, cardia: *thin}\n");
  EXPECT_DOUBLE_EQ(scene.tissue.thickness[0], 1.5e-3);
  EXPECT_DOUBLE_EQ(scene.tissue.thickness[1], 1.5e-3);
}

}  // namespace
}  // namespace vibe::scene_parser_test
