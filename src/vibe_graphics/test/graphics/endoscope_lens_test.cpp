// The lens on a viewport of a texture: what it shows, and that nothing of it stays. Needs no display.

#include "vibe_graphics/graphics/endoscope_lens.hpp"

#include <OgreCamera.h>
#include <OgreCompositorManager.h>
#include <OgreHardwarePixelBuffer.h>
#include <OgreMaterialManager.h>
#include <OgreRenderTexture.h>
#include <OgreSceneManager.h>
#include <OgreSceneNode.h>
#include <OgreTextureManager.h>
#include <OgreViewport.h>
#include <gtest/gtest.h>

#include <cmath>

#include "vibe_graphics/geometry/solid_bodies.hpp"
#include "vibe_graphics/graphics/offscreen_camera.hpp"
#include "vibe_graphics/graphics/shape_visual.hpp"
#include "vibe_graphics/testing/graphics_scene.hpp"

namespace vibe::graphics::endoscope_lens_test {
namespace {

using test::Pixels;
constexpr int kWidth = 200, kHeight = 160;

/// A ball in front of a camera at the origin of Ogre's world, which looks along -z.
class EndoscopeLensTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    scene_ = &test::graphicsScene();
    ball_ = new ShapeView(*scene_->getRootSceneNode(), copyMaterial("vibe/solid"));
    showBall({0, 0, -0.05});
    camera_ = scene_->createCamera("eye");
    camera_->setNearClipDistance(0.001F);
    camera_->setAspectRatio(1.25F);
    camera_->setFOVy(Ogre::Radian(0.8F));
    scene_->getRootSceneNode()->createChildSceneNode()->attachObject(camera_);
    picture_ = Ogre::TextureManager::getSingleton().createManual("window", kResourceGroup, Ogre::TEX_TYPE_2D, kWidth,
                                                                 kHeight, 0, Ogre::PF_BYTE_RGBA, Ogre::TU_RENDERTARGET);
    viewport_ = picture_->getBuffer()->getRenderTarget()->addViewport(camera_);
    viewport_->setBackgroundColour(Ogre::ColourValue(0, 0, 1));
  }

  static void showBall(const Eigen::Vector3d& place) {
    ColouredShape shape;
    appendSphere(Eigen::Isometry3d(Eigen::Translation3d(place)), 0.01, packed(1, 0.5, 0), shape);
    ball_->show(shape);
  }

  /// A red wall at this distance in place of the ball [m].
  static void showWall(double distance) {
    ColouredShape shape;
    appendBox(Eigen::Isometry3d(Eigen::Translation3d(0, 0, -distance - 0.005)), {0.4, 0.4, 0.01}, packed(1, 0, 0),
              shape);
    ball_->show(shape);
  }

  static Pixels draw() {
    Pixels pixels(3 * kWidth * kHeight);
    picture_->getBuffer()->getRenderTarget()->update();
    picture_->getBuffer()->blitToMemory(Ogre::PixelBox(kWidth, kHeight, 1, Ogre::PF_BYTE_RGB, pixels.data()));
    return pixels;
  }

  static int light(const Pixels& pixels, int x, int y) {
    const std::uint8_t* pixel = &pixels[static_cast<std::size_t>(3 * (y * kWidth + x))];
    return pixel[0] + pixel[1] + pixel[2];
  }

  static std::size_t resources() {
    auto count = [](auto& manager) {
      std::size_t number = 0;
      for (auto all = manager.getResourceIterator(); all.hasMoreElements(); all.moveNext()) ++number;
      return number;
    };
    return count(Ogre::TextureManager::getSingleton()) + count(Ogre::MaterialManager::getSingleton()) +
           count(Ogre::CompositorManager::getSingleton()) + scene_->getRootSceneNode()->numChildren() +
           scene_->getMovableObjects("Light").size();
  }

  static Ogre::SceneManager* scene_;
  static ShapeView* ball_;
  static Ogre::Camera* camera_;
  static Ogre::TexturePtr picture_;
  static Ogre::Viewport* viewport_;
};

Ogre::SceneManager* EndoscopeLensTest::scene_ = nullptr;
ShapeView* EndoscopeLensTest::ball_ = nullptr;
Ogre::Camera* EndoscopeLensTest::camera_ = nullptr;
Ogre::TexturePtr EndoscopeLensTest::picture_;
Ogre::Viewport* EndoscopeLensTest::viewport_ = nullptr;

TEST_F(EndoscopeLensTest, ShowsACircularImageOnBlackAndTheBallAtItsAngularSize) {
  EndoscopeLens lens(*viewport_);
  lens.set(LensKind::Equidistant, 140 * kDegree, 1);
  const Pixels pixels = draw();
  for (const int x : {0, kWidth - 1})
    for (const int y : {0, kHeight / 2, kHeight - 1}) EXPECT_EQ(light(pixels, x, y), 0) << x << " " << y;
  EXPECT_GT(light(pixels, kWidth / 2, kHeight / 2), 300);
  int bright = 0;
  for (int x = 0; x < kWidth; ++x) bright += light(pixels, x, kHeight / 2) > 60;
  const double angle = 2 * std::asin(0.01 / 0.05);
  EXPECT_NEAR(bright, kHeight * angle / (140 * kDegree), 2);
}

constexpr double kGain = 0.7;  // dark enough to tell distances near the lens

// What media/lamp.glsl, solid.frag and endoscope.frag show of a red wall that faces the lens: two light guides beside
// it, whose light falls off with the square of the distance, what other walls send back, then the exposure of the
// camera. Level of the red channel, 0 to 255.
double redAt(double distance) {
  const double reach = 0.06, gloss = 0.3, soft = 0.1, near = 0.04, aside = 0.0035, above = 0.0012;
  const double square = aside * aside + above * above + distance * distance;
  const double cosine = distance / std::sqrt(square);
  const double power = 2 * reach * reach / (square + near * near) * (0.15 + 0.35 * cosine);
  const double halfway = std::sqrt((1 + cosine) / 2);
  const double light =
      power * ((cosine + soft) / (1 + soft) + gloss * (0.5 * std::pow(halfway, 256) + 0.5 * std::pow(halfway, 32)));
  const double radiance = light + 0.05 * reach * reach / (distance * distance + 4e-4);
  return 255 * std::pow(1 - std::exp(-kGain * radiance), 0.6);
}

TEST_F(EndoscopeLensTest, LampOfTheEndoscopeFadesWithTheSquareOfTheDistance) {
  EndoscopeLens lens(*viewport_);
  lens.set(LensKind::Rectilinear, 60 * kDegree, 1);
  lens.setGain(kGain);
  for (const double distance : {0.04, 0.06, 0.09, 0.14, 0.2, 0.29}) {
    showWall(distance);
    const int red = draw()[3 * (kHeight / 2 * kWidth + kWidth / 2)];
    EXPECT_NEAR(red, redAt(distance), 1) << distance;                   // measured: 0.5, the rounding of a level
    EXPECT_GT(std::abs(red - redAt(1.1 * distance)), 1.5) << distance;  // control: a tenth farther away is seen
  }
  showBall({0, 0, -0.05});
}

TEST_F(EndoscopeLensTest, LeavesTheViewAsItWas) {
  const Pixels before = draw();
  const Ogre::Real aspect = camera_->getAspectRatio();
  const Ogre::Radian angle = camera_->getFOVy();
  Pixels during;
  {
    EndoscopeLens lens(*viewport_);
    lens.set(LensKind::Equidistant, 140 * kDegree, 1);
    during = draw();
  }
  EXPECT_EQ(viewport_->getMaterialScheme(), Ogre::MaterialManager::DEFAULT_SCHEME_NAME);
  camera_->setAspectRatio(aspect);  // the angles belong to who owns the camera
  camera_->setFOVy(angle);
  EXPECT_TRUE(before == draw());
  EXPECT_FALSE(before == during);
}

// As rviz ends: its window goes before its views. The address sanitizer sees a lens that does not notice.
TEST_F(EndoscopeLensTest, ViewportMayBeDeletedFirst) {
  Ogre::RenderTarget& target = *picture_->getBuffer()->getRenderTarget();
  auto useOnce = [&target] {
    Ogre::Viewport* other = target.addViewport(camera_, 1, 0, 0, 0.5F, 0.5F);
    EndoscopeLens lens(*other);
    lens.set(LensKind::Equidistant, 140 * kDegree, 1);
    draw();
    target.removeViewport(1);
    lens.set(LensKind::Rectilinear, 100 * kDegree, 1);  // nothing to set it on any more
  };
  useOnce();
  const std::size_t before = resources();
  useOnce();
  EXPECT_EQ(resources(), before);
}

TEST_F(EndoscopeLensTest, LeavesNoResourcesBehind) {
  auto useOnce = [] {
    EndoscopeLens lens(*viewport_);
    for (const double degrees : {60., 100., 140.}) {
      lens.set(LensKind::Equidistant, degrees * kDegree, 1);
      draw();
    }
    EXPECT_GT(scene_->getMovableObjects("Light").size(), 0u);
  };
  useOnce();
  const std::size_t before = resources();
  for (int k = 0; k < 10; ++k) useOnce();
  EXPECT_EQ(resources(), before);
}

TEST_F(EndoscopeLensTest, TwoCamerasOfOneSceneDoNotDisturbEachOther) {
  RoundCamera round;
  round.width = round.height = 120;
  OffscreenCamera first(*scene_, round, 1), second(*scene_, round, 1);
  // the optical frame of a camera that looks along -z of the world, y up
  Eigen::Isometry3d ahead = Eigen::Isometry3d::Identity(), behind = ahead;
  ahead.linear() = Eigen::Vector3d(1, -1, -1).asDiagonal();
  Pixels alone, again, away;
  first.take(ahead, alone);
  second.take(behind, away);
  first.take(ahead, again);
  EXPECT_TRUE(alone == again);
  EXPECT_FALSE(alone == away);
  EXPECT_GT(alone[3 * (60 * 120 + 60)], 100);
  EXPECT_EQ(away[3 * (60 * 120 + 60)], 0);
}

}  // namespace
}  // namespace vibe::graphics::endoscope_lens_test
