// Every stomach that is shipped as a scene.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "geometry/mesh_quality.hpp"
#include "geometry/regions.hpp"
#include "geometry/stomach_knots.hpp"
#include "geometry/surface_check.hpp"
#include "vibe_core/builder/model_builder.hpp"
#include "vibe_core/geometry/triangle_tree.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/scene/scene_parser.hpp"
#include "vibe_core/scene/schema.hpp"
#include "vibe_core/simulation/simulation.hpp"

namespace vibe::organ_shapes_test {
namespace {

Scene shipped(const std::string& name) {
  return loadScene(VIBE_CORE_DIR "/scenes/" + name + ".yaml");
}

const Organ& organOf(std::string_view name) {
  static std::map<std::string, Organ, std::less<>> organs;
  const auto known = organs.find(name);
  return known != organs.end() ? known->second
                               : organs.emplace(name, buildOrgan(shipped(std::string(name)))).first->second;
}

double alongOf(const Organ& organ, const StomachAxis& axis, const Eigen::Vector3d& place) {
  const TriangleTree tree(organ.surface);
  return axis.lengthAt(organ.surface.triangles[tree.closest(place).triangle][0]) / axis.length();
}

double lowest(const Organ& organ) {
  double z = 1;
  for (const auto& v : organ.surface.vertices) z = std::min(z, v.z());
  return z;
}

class ShippedStomach : public testing::TestWithParam<std::string> {};

TEST_P(ShippedStomach, IsAnEvenClosedSurfaceOfItsVolume) {
  const Organ& organ = organOf(GetParam());
  const GeometryScene geometry = shipped(GetParam()).geometry;
  EXPECT_NO_THROW(checkSurface(organ.surface, GetParam()));
  EXPECT_EQ(organ.surface.vertices.size(), 3618u);
  const double volume = geometry.volume * std::pow(geometry.scale, 3);
  EXPECT_NEAR(enclosedVolume(organ.surface), volume, 1e-9 * volume);
  const test::MeshQuality quality = test::measureQuality(organ.surface);
  EXPECT_LT(quality.edge_variation, 0.12);
  EXPECT_GT(quality.smallest_angle, 30 * M_PI / 180);
}

TEST_P(ShippedStomach, LandmarksFollowEachOtherAlongTheAxis) {
  const Organ& organ = organOf(GetParam());
  const Landmarks& l = organ.landmarks;
  const StomachAxis axis = findAxis(organ);
  EXPECT_LT(alongOf(organ, axis, l.fundus), 0.02);
  EXPECT_GT(alongOf(organ, axis, l.oesophagus), 0.1);
  EXPECT_GT(alongOf(organ, axis, l.incisura), alongOf(organ, axis, l.oesophagus) + 0.2);
  EXPECT_GT(alongOf(organ, axis, l.pylorus), alongOf(organ, axis, l.incisura) + 0.15);
  EXPECT_LT(alongOf(organ, axis, l.pylorus), 0.99);
  EXPECT_GT(l.fundus.z(), l.oesophagus.z() + 0.02);   // the dome rises above the junction
  EXPECT_LT(l.pylorus.y(), l.oesophagus.y() - 0.03);  // the pylorus is on the right
}

TEST_P(ShippedStomach, HasEveryRegionAndWall) {
  const Organ& organ = organOf(GetParam());
  for (int r = 0; r < kRegionCount; ++r)
    EXPECT_GT(std::count(organ.region.begin(), organ.region.end(), static_cast<Region>(r)), 100) << r;
  for (int w = 0; w < kWallCount; ++w)
    EXPECT_GT(std::count(organ.wall.begin(), organ.wall.end(), static_cast<Wall>(w)), 500) << w;
  EXPECT_GE(std::count(organ.end.begin(), organ.end.end(), End::Oesophagus), 10);
  EXPECT_GE(std::count(organ.end.begin(), organ.end.end(), End::Duodenum), 10);
}

TEST_P(ShippedStomach, LetsAStraightScopeIn) {
  const Organ& organ = organOf(GetParam());
  const TriangleTree tree(organ.surface);
  const double length = 0.1 * shipped(GetParam()).geometry.scale;
  for (double s = 0; s <= length; s += 1e-3)  // radius of the scope and half of the wall
    EXPECT_GT(tree.closest(organ.entry + s * organ.entry_axis).distance, 7.5e-3) << "at " << s * 1e3 << " mm";
}

// Between 0.36 L (fed, magnetic resonance imaging) and 2.0 L (filled until the pressure rises, Yehoshua 2008), and of
// the compliance of resected specimens, 14 to 86 mL/mmHg (Toro 2015).
TEST_P(ShippedStomach, HoldsTheVolumeOfAStomachAtItsPressure) {
  Scene scene = shipped(GetParam());
  scene.geometry.particles = 700;
  scene.gas->flow_limit = 1e-3;
  scene.scope.reset(), scene.helix.reset(), scene.suture.reset(), scene.bleeding.reset(), scene.marking.reset();
  Simulation simulation(buildModel(scene, ""));
  StepInput input;
  input.buttons[Insufflate] = 1;
  const double rest = simulation.state().volume;
  for (int k = 0; k < 300; ++k) simulation.step(input);
  const State& state = simulation.state();
  EXPECT_NEAR(state.pressure, scene.gas->regulated_pressure, 0.01 * state.pressure);
  EXPECT_GT(state.volume, 0.36e-3);
  EXPECT_LT(state.volume, 2.0e-3);
  const double secant = (state.volume - rest) / (state.pressure / 133.322);
  RecordProperty("capacity_mL", std::to_string(1e6 * state.volume));
  EXPECT_GT(secant, 14e-6);
  EXPECT_LT(secant, 86e-6);
}

INSTANTIATE_TEST_SUITE_P(Scenes, ShippedStomach,
                         testing::Values("stomach", "stomach_small", "stomach_large", "stomach_j", "stomach_steer_horn",
                                         "stomach_8mmhg", "stomach_12mmhg"));

TEST(OrganShapes, DifferAsTheirTypesDo) {
  const Organ &usual = organOf("stomach"), &j = organOf("stomach_j"), &horn = organOf("stomach_steer_horn");
  const auto size = [](const Organ& organ) {
    Eigen::AlignedBox3d box;
    for (const auto& v : organ.surface.vertices) box.extend(v);
    return Eigen::Vector3d(box.sizes());
  };
  EXPECT_GT(size(j).z() / size(j).y(), 1.5);        // vertical
  EXPECT_LT(size(horn).z() / size(horn).y(), 0.8);  // transverse
  EXPECT_NEAR(size(usual).z() / size(usual).y(), 1, 0.1);
  // the lowest part: below the pylorus by far in a J, and hardly so in a steer horn, which ends there
  EXPECT_GT(j.landmarks.pylorus.z() - lowest(j), 0.08);
  EXPECT_LT(horn.landmarks.pylorus.z() - lowest(horn), 0.03);
  EXPECT_GT(findAxis(j).length(), 1.15 * findAxis(usual).length());
  EXPECT_LT(findAxis(horn).length(), findAxis(usual).length());
}

// The corners of the ranges of fundus and antrum, and the middle.
TEST(OrganShapes, AnyFundusAndAntrumMakesAnOrgan) {
  for (const std::string& word : stomachShapes())
    for (const double width : {0.9, 1.0, 1.25})
      for (const double degrees : {-25.0, 0.0, 25.0}) {
        SCOPED_TRACE(word + " " + std::to_string(width) + " " + std::to_string(degrees));
        Scene scene;
        scene.geometry.particles = 1500;
        scene.geometry.shape = word;
        scene.geometry.fundus_width = width;
        scene.geometry.antrum_angle = degrees * M_PI / 180;
        const Organ organ = buildOrgan(scene);
        EXPECT_NO_THROW(checkSurface(organ.surface, word));
        EXPECT_NEAR(enclosedVolume(organ.surface), scene.geometry.volume, 1e-9 * scene.geometry.volume);
        for (int r = 0; r < kRegionCount; ++r)
          EXPECT_GT(std::count(organ.region.begin(), organ.region.end(), static_cast<Region>(r)), 30) << r;
        const TriangleTree tree(organ.surface);
        for (double s = 0; s <= 0.1; s += 2e-3)
          EXPECT_GT(tree.closest(organ.entry + s * organ.entry_axis).distance, 7e-3) << s;
      }
}

TEST(OrganShapes, FundusAndAntrumAreThoseOfTheScene) {
  Scene scene;
  scene.geometry.particles = 1500;
  const Organ usual = buildOrgan(scene);
  scene.geometry.antrum_angle = 20 * M_PI / 180;
  const Landmarks up = buildOrgan(scene).landmarks;
  const auto direction = [](const Landmarks& l) {  // of the antrum, in the frontal plane
    return std::atan2(l.pylorus.z() - l.incisura.z(), l.incisura.y() - l.pylorus.y());
  };
  EXPECT_NEAR(direction(up) - direction(usual.landmarks), scene.geometry.antrum_angle, 0.03);
  scene.geometry.antrum_angle = 0;
  scene.geometry.fundus_width = 1.25;
  const Organ wide = buildOrgan(scene);
  const auto fundus = [](const Organ& organ) {
    Eigen::AlignedBox3d box;
    for (std::size_t v = 0; v < organ.region.size(); ++v)
      if (organ.region[v] == Region::Fundus) box.extend(organ.surface.vertices[v]);
    return box.sizes().x();
  };
  EXPECT_NEAR(fundus(wide) / fundus(usual), 1.15, 0.06);  // the whole is smaller for the same volume
}

TEST(OrganShapes, ScaleMultipliesLengthsButNotTubesAndWall) {
  const Organ &usual = organOf("stomach"), &large = organOf("stomach_large");
  const auto tube = [](const Organ& organ) {
    return TriangleTree(organ.surface).closest(organ.entry + 0.01 * organ.entry_axis).distance;
  };
  EXPECT_NEAR(findAxis(large).length() / findAxis(usual).length(), 1.15, 0.02);
  EXPECT_NEAR(tube(large) / tube(usual), 1, 0.08);
  EXPECT_NEAR(*std::max_element(large.thickness.begin(), large.thickness.end()),
              *std::max_element(usual.thickness.begin(), usual.thickness.end()), 1e-6);
  Scene sphere;
  sphere.geometry.kind = GeometryScene::Kind::Sphere;
  sphere.geometry.particles = 200;
  sphere.geometry.scale = 1.5;
  for (const auto& v : buildOrgan(sphere).surface.vertices) EXPECT_NEAR(v.norm(), 0.075, 1e-12);
}

TEST(OrganShapes, ScaleAndVolumeHaveALimitTogether) {
  Scene scene;
  scene.geometry.volume = 0.6e-3;
  scene.geometry.scale = 0.5;
  EXPECT_THROW(buildOrgan(scene), Error);
}

TEST(OrganShapes, TheSchemaHasTheirWords) {
  EXPECT_EQ(findRow("geometry.shape")->words, stomachShapes());
  for (const std::string& word : stomachShapes()) EXPECT_NO_THROW(stomachKnots(word));
  EXPECT_THROW(stomachKnots("cascade"), Error);
}

}  // namespace
}  // namespace vibe::organ_shapes_test
