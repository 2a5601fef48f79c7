// What the device hides from the light guides: a rod between lens and wall. Needs no display.
#include <OgreEntity.h>
#include <OgreSceneManager.h>
#include <OgreSceneNode.h>
#include <gtest/gtest.h>
#include <rviz/mesh_loader.h>

#include "vibe_graphics/graphics/endoscope_lamp.hpp"
#include "vibe_graphics/graphics/offscreen_camera.hpp"
#include "vibe_graphics/graphics/tissue_visual.hpp"
#include "vibe_graphics/testing/graphics_scene.hpp"
#include "vibe_graphics/testing/tube_organ.hpp"

namespace vibe::graphics::device_shadow_test {
namespace {

constexpr int kSize = 200;                                 // [px]
constexpr double kWall = 0.060, kRod = 0.020;              // distance from the lens [m]
constexpr double kGuideAside = 0.0035, kRodAside = 0.008;  // [m]
constexpr double kHalfAngle = 0.9;                         // of the picture [rad]

/// Column where a place this far to the right of the axis is seen.
int columnOf(double aside, double distance) {
  return static_cast<int>(0.5 * kSize * (1 + aside / distance / std::tan(kHalfAngle)));
}

/// Column of the shadow that the rod casts on the wall, away from a guide at this place.
int shadowOf(double guide) {
  return columnOf(guide + (kRodAside - guide) * kWall / kRod, kWall);
}

class DeviceShadowTest : public ::testing::Test {
 protected:
  void SetUp() override {
    organ_.radius = 0.06;
    tissue_ = std::make_unique<TissueVisual>(*test::graphicsScene().getRootSceneNode());
    tissue_->setMesh(organ_.mesh());
    TissueFrame frame;
    frame.revision = 1;
    frame.positions = organ_.places(1.15);  // smooth
    tissue_->setFrame(frame);
    const double radius = 1.15 * organ_.radius;
    camera_pose_.translation() = Eigen::Vector3d(0, 0, radius - kWall);
    addRod(camera_pose_ * Eigen::Vector3d(kRodAside, -0.0045, kRod));
  }
  void TearDown() override {
    setLamp({});
    tissue_.reset();
    test::graphicsScene().destroyEntity(rod_);
    test::graphicsScene().destroySceneNode(node_);
  }

  /// 6.4 mm along y, 2 mm thick: a piece of the shaft, much smaller.
  void addRod(const Eigen::Vector3d& from) {
    const Ogre::MeshPtr mesh = rviz::loadMeshFromResource("package://vibe_description/meshes/shaft_piece.obj");
    ASSERT_TRUE(mesh);
    rod_ = test::graphicsScene().createEntity(mesh);
    node_ = test::graphicsScene().getRootSceneNode()->createChildSceneNode();
    node_->attachObject(rod_);
    node_->setScale(0.16F, 0.16F, 0.16F);
    node_->setOrientation(Ogre::Quaternion(Ogre::Degree(90), Ogre::Vector3::UNIT_Z));
    node_->setPosition(static_cast<float>(from.x()), static_cast<float>(from.y()), static_cast<float>(from.z()));
  }

  std::vector<std::uint8_t> picture(bool with_rod) {
    rod_->setVisible(with_rod);
    OffscreenCamera camera(test::graphicsScene(), {LensKind::Rectilinear, 2 * kHalfAngle, kSize, kSize}, 1);
    std::vector<std::uint8_t> pixels;
    camera.take(camera_pose_, pixels);
    return pixels;
  }

  /// Mean green light of a few rows at the height of the guides, in columns around this one, before the tone curve of
  /// media/endoscope.frag.
  static double light(const std::vector<std::uint8_t>& pixels, int column) {
    double sum = 0;
    for (int y = kSize / 2 - 5; y < kSize / 2 - 1; ++y)
      for (int x = column - 2; x <= column + 2; ++x) {
        const double level = pixels[static_cast<std::size_t>(3 * (y * kSize + x) + 1)] / 255.0;
        sum -= std::log(1 - std::pow(level, 1 / 0.6));
      }
    return sum / 20;
  }

  test::TubeOrgan organ_;
  std::unique_ptr<TissueVisual> tissue_;
  Eigen::Isometry3d camera_pose_ = Eigen::Isometry3d::Identity();
  Ogre::Entity* rod_ = nullptr;
  Ogre::SceneNode* node_ = nullptr;
};

TEST_F(DeviceShadowTest, EachGuideThrowsAHalfShadowWhereItShould) {
  const std::vector<std::uint8_t> lit = picture(false), shaded = picture(true);
  const auto part = [&](int column) { return light(shaded, column) / light(lit, column); };
  for (const double guide : {-kGuideAside, kGuideAside}) {
    std::printf("shadow of the guide at %+.1f mm, column %d: %.2f of the light\n", 1e3 * guide, shadowOf(guide),
                part(shadowOf(guide)));
    EXPECT_NEAR(part(shadowOf(guide)), 0.55, 0.12) << guide;  // the other guide, and a little light from everywhere
  }
  for (const int column : {30, 60, 100, shadowOf(-kGuideAside) + 22})  // control: beside the shadows
    EXPECT_NEAR(part(column), 1, 0.02) << column;
}

TEST_F(DeviceShadowTest, ShadowsFollowTheGuides) {
  EndoscopeLight lamp;
  lamp.guides[0].right = 0.0065, lamp.guides[1].right = -0.0075;
  setLamp(lamp);
  const std::vector<std::uint8_t> lit = picture(false), shaded = picture(true);
  const auto part = [&](int column) { return light(shaded, column) / light(lit, column); };
  for (const LightGuide& guide : lamp.guides) EXPECT_NEAR(part(shadowOf(guide.right)), 0.55, 0.12) << guide.right;
  EXPECT_NEAR(part(shadowOf(-kGuideAside)), 1, 0.1);  // control: where the usual guide would throw it
}

TEST_F(DeviceShadowTest, RodBehindTheGuidesThrowsNone) {
  const std::vector<std::uint8_t> lit = picture(false);
  node_->translate(0, 0, static_cast<float>(-kRod - 0.002));
  EXPECT_EQ(picture(true), lit);
}

}  // namespace
}  // namespace vibe::graphics::device_shadow_test
