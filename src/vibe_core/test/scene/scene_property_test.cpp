// Properties of the scene parser over many random scenes, with fixed seeds.
#include <gtest/gtest.h>

#include <fstream>
#include <random>
#include <sstream>

#include "scene/mutation.hpp"
#include "scene/scene_keys.hpp"
#include "vibe_core/scene/scene_parser.hpp"
#include "vibe_core/scene/schema.hpp"
#include "vibe_testing/expect_error.hpp"

namespace vibe::scene_property_test {
namespace {

/// Puts a random allowed value where a row lives.
struct Randomise {
  const SchemaRow& row;
  Scene& scene;
  std::mt19937_64& random;

  double value() const { return std::uniform_real_distribution<double>(row.low, row.high)(random); }
  double whole() const { return std::floor(value()); }
  void operator()(bool& (*at)(Scene&)) const { at(scene) = random() % 2 == 0; }
  void operator()(int& (*at)(Scene&)) const { at(scene) = static_cast<int>(whole()); }
  void operator()(std::uint64_t& (*at)(Scene&)) const { at(scene) = static_cast<std::uint64_t>(whole()); }
  void operator()(double& (*at)(Scene&)) const { at(scene) = value(); }
  void operator()(Eigen::Vector3d& (*at)(Scene&)) const { at(scene) = {value(), value(), value()}; }
  void operator()(std::array<double, 3>& (*at)(Scene&)) const { at(scene) = {value(), value(), value()}; }
  void operator()(std::vector<double>& (*at)(Scene&)) const { at(scene) = {value(), value()}; }
  void operator()(std::optional<Eigen::Vector3d>& (*at)(Scene&)) const {
    at(scene) = Eigen::Vector3d(value(), value(), value());
  }
  void operator()(GeometryScene::Kind& (*)(Scene&)) const {}
  void operator()(std::string& (*at)(Scene&)) const {
    static const std::string letters = "abc XYZ'\"#:{}[],&*!|>%@`~-_.?\\0123\u00e4";
    const std::vector<std::string> words = wordsOf(row);
    if (!words.empty()) {
      at(scene) = words[random() % words.size()];
      return;
    }
    std::string text = "/";  // an absolute path stays as it is
    for (int k = static_cast<int>(random() % 12); k >= 0; --k) text += letters[random() % letters.size()];
    at(scene) = text + "x";
  }
};

/// Rows are drawn one by one; some must fit together.
void repair(Scene& scene) {
  if (auto& relaxation = scene.tissue.relaxation) {
    for (double& ratio : relaxation->ratios) ratio *= 0.4;
    for (double& time : relaxation->times) time += 5 * scene.step_period;
    if (scene.tissue.model != "shell") relaxation.reset();
  }
  if (scene.suture) {
    SutureScene& s = *scene.suture;
    if (s.min_bites > s.max_bites) std::swap(s.min_bites, s.max_bites);
    if (s.cinch_tension > s.thread_strength) std::swap(s.cinch_tension, s.thread_strength);
    if (s.loose_tension >= s.cinch_tension) s.loose_tension = s.cinch_tension / 2;
  }
  if (scene.marking) {
    ApcParameters& apc = scene.marking->apc;
    if (apc.burn_energy > apc.deep_energy) std::swap(apc.burn_energy, apc.deep_energy);
    if (apc.mark_energy > apc.burn_energy) std::swap(apc.mark_energy, apc.burn_energy);
    if (apc.burn_energy > apc.deep_energy) std::swap(apc.burn_energy, apc.deep_energy);
  }
  if (scene.bleeding) scene.bleeding->mild_probability *= 1 - scene.bleeding->brisk_probability;
}

Scene randomScene(std::mt19937_64& random) {
  Scene scene;
  for (const SchemaSection& section : sceneSections()) {
    const std::string parent = sectionOf(section.name);
    const bool reachable = (parent.empty() || findSection(parent)->isPresent(scene)) &&
                           (section.needs == nullptr || findSection(section.needs)->isPresent(scene));
    if (reachable && random() % 2 == 0) section.enter(scene);
  }
  scene.geometry.kind = static_cast<GeometryScene::Kind>(random() % 3);
  for (const SchemaRow& row : sceneSchema()) {
    const bool applies = !row.only_for || *row.only_for == scene.geometry.kind;
    if (applies && findSection(sectionOf(row.key))->isPresent(scene)) {
      std::visit(Randomise{row, scene, random}, row.access);
    }
    const bool landmark = sectionOf(row.key) == "geometry.landmarks";
    if (applies && landmark) std::visit(Randomise{row, scene, random}, row.access);
  }
  repair(scene);
  return scene;
}

/// Bit for bit, except for where it was read.
void expectEqual(Scene a, Scene b) {
  for (const SchemaSection& section : sceneSections()) {
    ASSERT_EQ(section.isPresent(a), section.isPresent(b)) << section.name;
    if (!section.isPresent(a)) continue;
    for (const SchemaRow& row : sceneSchema()) {
      if (sectionOf(row.key) != section.name) continue;
      EXPECT_EQ(valueText(row, a), valueText(row, b)) << row.key;
    }
  }
}

TEST(SceneProperty, RandomScenesRoundTrip) {
  std::mt19937_64 random(20);
  for (int k = 0; k < 500; ++k) {
    const Scene scene = randomScene(random);
    const std::string yaml = toYaml(scene);
    const std::string message = errorOf([&] { expectEqual(parseScene(yaml, "s.yaml"), scene); });
    ASSERT_EQ(message, "no error") << yaml;
    if (HasFailure()) FAIL() << yaml;
  }
}

/// The round trip would be worthless if the comparison did not see a difference.
TEST(SceneProperty, ComparisonSeesEveryRow) {
  for (const SchemaRow& row : sceneSchema()) {
    std::mt19937_64 random(7);
    Scene a = completeScene();
    Scene b = a;
    if (std::holds_alternative<GeometryScene::Kind& (*)(Scene&)>(row.access)) continue;
    // packages may add words to a list that has one
    if (const auto* text = std::get_if<std::string& (*)(Scene&)>(&row.access); text && wordsOf(row).size() == 1)
      (*text)(b) = "another";
    for (int k = 0; k < 20 && valueText(row, a) == valueText(row, b); ++k) {
      std::visit(Randomise{row, b, random}, row.access);
    }
    EXPECT_NE(valueText(row, a), valueText(row, b)) << row.key;
  }
}

TEST(SceneProperty, ShippedScenesRoundTrip) {
  for (const char* name : {"stomach", "stomach_minimal", "sphere"}) {
    const Scene scene = loadScene(std::string(VIBE_CORE_DIR) + "/scenes/" + name + ".yaml");
    expectEqual(parseScene(toYaml(scene), "s.yaml"), scene);
  }
}

TEST(SceneProperty, DamagedScenesGiveASceneOrAnErrorWithItsPlace) {
  Mutator mutator(1000);
  int good = 0, refused = 0;
  for (const char* name : {"stomach", "stomach_minimal", "sphere", "imported_mesh"}) {
    std::stringstream text;
    text << std::ifstream(std::string(VIBE_CORE_DIR) + "/scenes/" + name + ".yaml").rdbuf();
    for (int k = 0; k < 1000; ++k) {
      const std::string damaged = mutator.mutate(text.str());
      const std::string message = errorOf([&] { parseScene(damaged, "m.yaml"); });
      (message == "no error" ? good : refused) += 1;
      const bool has_place = message.rfind("m.yaml:", 0) == 0 && std::isdigit(static_cast<unsigned char>(message[7]));
      ASSERT_TRUE(message == "no error" || has_place) << message << "\n" << damaged;
      ASSERT_EQ(message.find('\n'), std::string::npos) << message;
    }
  }
  // Both happen often, so that neither branch is untested.
  EXPECT_GT(good, 100);
  EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace vibe::scene_property_test
