// Smoke and ageing marks in the picture of the endoscope: properties of pictures, not pictures. Needs no display.
#include <OgreCamera.h>
#include <OgreHardwarePixelBuffer.h>
#include <OgreRenderTexture.h>
#include <OgreSceneManager.h>
#include <OgreSceneNode.h>
#include <OgreTechnique.h>
#include <OgreTextureManager.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "vibe_graphics/geometry/solid_bodies.hpp"
#include "vibe_graphics/graphics/offscreen_camera.hpp"
#include "vibe_graphics/graphics/shape_visual.hpp"
#include "vibe_graphics/graphics/tissue_visual.hpp"
#include "vibe_graphics/testing/graphics_scene.hpp"
#include "vibe_graphics/testing/tube_organ.hpp"

namespace vibe::graphics::smoke_view_test {
namespace {

using test::Pixels;
constexpr int kSize = 200;  // [px]

class SmokeViewTest : public ::testing::Test {
 protected:
  void SetUp() override {
    RoundCamera round;
    round.width = round.height = kSize;
    camera_ = std::make_unique<OffscreenCamera>(test::graphicsScene(), round, 1);
    tissue_ = std::make_unique<TissueVisual>(*test::graphicsScene().getRootSceneNode());
    tissue_->setMesh(organ_.mesh());
    frame_.positions = organ_.places(1.06);
    frame_.grade.assign(organ_.mesh().particle_count, 0);
    frame_.dose.assign(organ_.mesh().particle_count, 0);
    tissue_->setFrame(frame_);
  }
  void TearDown() override { tissue_.reset(), camera_.reset(); }

  /// A dose on all of the wall that makes smoke of this extinction [1/m].
  void burn(double extinction) {
    Smoke smoke(organ_.mesh());
    smoke.see(frame_);
    TissueFrame unit = frame_;
    for (float& dose : unit.dose) dose += 1;
    smoke.see(unit);
    for (float& dose : frame_.dose) dose += static_cast<float>(extinction / (kSmokePerJoule * smoke.energy()));
    tissue_->setFrame(frame_);
  }
  void wait(double seconds) {
    frame_.time += seconds;
    tissue_->setFrame(frame_);
  }

  static Eigen::Isometry3d along() {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() << 0, 0, 1, 1, 0, 0, 0, 1, 0;
    return pose;
  }
  /// Looks at the wall at z of the organ, or at the opposite one.
  static Eigen::Isometry3d at(double distance, bool opposite = false) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translate(Eigen::Vector3d(0, 0, (opposite ? -1 : 1) * (0.04 * 1.06 - distance)));
    if (opposite) pose.rotate(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()));
    return pose;
  }

  /// With a fixed exposure.
  Pixels picture(const Eigen::Isometry3d& pose) {
    Pixels pixels;
    camera_->take(pose, pixels);
    return pixels;
  }

  struct Ring {
    double contrast, saturation;  // of green: see below; (red - blue) / red
  };
  /// A circle around the picture's middle; along the tube this is the wall at one distance. Contrast is the root mean
  /// square difference to the mean over 24 degrees, two folds, by the mean: wisps are broader.
  static Ring ringAt(const Pixels& pixels, double share) {
    constexpr int kPoints = 720, kHalf = 24;
    std::vector<double> green;
    double sum[3] = {0, 0, 0};
    for (int k = 0; k < kPoints; ++k) {
      const double angle = 2 * M_PI * k / kPoints, r = share * kSize / 2;
      const int x = static_cast<int>(kSize / 2 + r * std::cos(angle)),
                y = static_cast<int>(kSize / 2 + r * std::sin(angle));
      const std::uint8_t* pixel = &pixels[static_cast<std::size_t>(3 * (y * kSize + x))];
      for (int c = 0; c < 3; ++c) sum[c] += pixel[c];
      green.push_back(pixel[1]);
    }
    double squares = 0;
    for (int k = 0; k < kPoints; ++k) {
      double around = 0;
      for (int n = -kHalf; n <= kHalf; ++n) around += green[(k + n + kPoints) % kPoints] / (2 * kHalf + 1);
      squares += (green[k] - around) * (green[k] - around);
    }
    return {std::sqrt(squares / kPoints) / (sum[1] / kPoints), (sum[0] - sum[2]) / sum[0]};
  }

  /// Mean of a square in the middle.
  template <int kHalf = 8>
  static Eigen::Vector3d middle(const Pixels& pixels) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int y = kSize / 2 - kHalf; y < kSize / 2 + kHalf; ++y)
      for (int x = kSize / 2 - kHalf; x < kSize / 2 + kHalf; ++x)
        for (int c = 0; c < 3; ++c) sum[c] += pixels[static_cast<std::size_t>(3 * (y * kSize + x) + c)];
    return sum / (4 * kHalf * kHalf);
  }

  double ofBall(double distance, double grey);

  static int largestDifference(const Pixels& a, const Pixels& b) {
    int largest = 0;
    for (std::size_t k = 0; k < a.size(); ++k) largest = std::max(largest, std::abs(int{a[k]} - int{b[k]}));
    return largest;
  }

  bool is_bluish_ = false;
  test::TubeOrgan organ_;
  TissueFrame frame_;
  std::unique_ptr<OffscreenCamera> camera_;
  std::unique_ptr<TissueVisual> tissue_;
};

TEST_F(SmokeViewTest, FarWallLosesMoreContrastAndColourThanNearWall) {
  constexpr double kFar = 0.45, kNear = 0.9;  // of the radius: 31 and 63 degrees, 81 and 48 mm away
  const Pixels clear = picture(along());
  burn(6);
  const Pixels hazy = picture(along());
  const Ring far = ringAt(clear, kFar), near = ringAt(clear, kNear);
  const Ring hazy_far = ringAt(hazy, kFar), hazy_near = ringAt(hazy, kNear);
  std::printf("contrast far %.3f to %.3f, near %.3f to %.3f; saturation far %.3f to %.3f, near %.3f to %.3f\n",
              far.contrast, hazy_far.contrast, near.contrast, hazy_near.contrast, far.saturation, hazy_far.saturation,
              near.saturation, hazy_near.saturation);
  EXPECT_LT(hazy_near.contrast, 0.95 * near.contrast);
  EXPECT_LT(hazy_far.contrast / far.contrast, 0.7 * hazy_near.contrast / near.contrast);
  EXPECT_LT(hazy_near.saturation, 0.95 * near.saturation);
  EXPECT_LT(hazy_far.saturation / far.saturation, 0.7 * hazy_near.saturation / near.saturation);
  EXPECT_GT(hazy_near.contrast, 0.25 * near.contrast) << "the wall at 48 mm must be recognised";
}

TEST_F(SmokeViewTest, IsGoneAfterSomeTime) {
  const Pixels clear = picture(along());
  burn(6);
  wait(2 * kSmokeLife);
  EXPECT_GT(largestDifference(picture(along()), clear), 3);  // control
  wait(5 * kSmokeLife);
  EXPECT_LE(largestDifference(picture(along()), clear), 1);
  wait(4 * kSmokeLife);
  EXPECT_TRUE(picture(along()) == clear);
}

TEST_F(SmokeViewTest, NoSmokeChangesNoPixel) {
  const Pixels clear = picture(along());
  EXPECT_EQ(test::graphicsScene().getFogDensity(), 0);
  burn(6);
  EXPECT_FALSE(picture(along()) == clear);  // control
  TissueLook look;
  look.smoke = false;
  tissue_->setLook(look);
  EXPECT_TRUE(picture(along()) == clear);
  tissue_->setLook({});
  EXPECT_FALSE(picture(along()) == clear);
  tissue_->setMesh(organ_.mesh());  // another organ has no smoke
  frame_.time = 0;
  tissue_->setFrame(frame_);
  EXPECT_TRUE(picture(along()) == clear);
}

TEST_F(SmokeViewTest, DoesNotDependOnWhichFramesAreDrawn) {
  burn(6);
  wait(20);
  const Pixels seldom = picture(along());
  tissue_->setMesh(organ_.mesh());
  std::fill(frame_.dose.begin(), frame_.dose.end(), 0.0F);
  frame_.time = 0;
  tissue_->setFrame(frame_);
  burn(6);
  const TissueFrame burnt = frame_;
  for (int k = 1; k < 20; ++k) frame_.time = k, tissue_->follow(frame_);
  EXPECT_FALSE(picture(along()) == seldom);  // control: not drawn yet
  frame_ = burnt;
  wait(20);
  EXPECT_LE(largestDifference(picture(along()), seldom), 1);
}

// A filter that waits for transforms gives messages away in another order than they came.
TEST_F(SmokeViewTest, OvertakenFramesTellNothing) {
  burn(6);
  std::fill(frame_.grade.begin(), frame_.grade.end(), std::uint8_t{1});
  wait(10);
  const Pixels before = picture(along());
  frame_.time -= 0.1;
  frame_.dose.assign(frame_.dose.size(), 0);
  tissue_->follow(frame_);
  tissue_->setLook({});
  EXPECT_TRUE(picture(along()) == before);
  frame_.time -= 5;  // control: time is set back
  tissue_->follow(frame_);
  tissue_->setLook({});
  EXPECT_FALSE(picture(along()) == before);
  EXPECT_EQ(test::graphicsScene().getFogDensity(), 0);
}

TEST_F(SmokeViewTest, SmokeOfSeveralOrgansAddsUpAndLeavesNothing) {
  SceneSmoke one(test::graphicsScene()), other(test::graphicsScene());
  one.set(0.1, 0), other.set(0.7, 0);
  EXPECT_NEAR(test::graphicsScene().getFogDensity(), 0.8, 0.005);
  one.set(0, 0);
  EXPECT_NEAR(test::graphicsScene().getFogDensity(), 0.7, 0.005);
  other.set(0, 0);
  EXPECT_EQ(test::graphicsScene().getFogDensity(), 0);
}

/// Radiance in the middle of the picture of a ball on the axis, whose nearest point has this distance:
/// media/endoscope.frag turned around. The middle of the three channels.
double SmokeViewTest::ofBall(double distance, double grey) {
  constexpr double kRadius = 0.012;
  ColouredShape shape;
  const Eigen::Translation3d place(distance + kRadius, 0, 0);
  appendSphere(Eigen::Isometry3d(place), kRadius, packed(grey, grey, grey), shape);
  Ogre::MaterialPtr material = copyMaterial("vibe/solid");
  for (Ogre::Technique* technique : material->getTechniques())
    technique->getPass(0)->getFragmentProgramParameters()->setNamedConstant("gloss", 0.0F);
  auto ball = std::make_unique<ShapeView>(*test::graphicsScene().getRootSceneNode(), material);
  ball->show(shape);
  const Eigen::Vector3d colour = middle<2>(picture(along()));
  ball.reset();
  dropMaterial(material);
  if (colour[1] > 60) is_bluish_ = colour[2] > colour[1] && colour[1] > colour[0];
  return -std::log(1 - std::pow(colour[1] / 255, 1 / 0.6)) / AutoExposure::kFixedGain;
}

// Against the equation in media/lamp.glsl with its numbers, the integral by the rule of rectangles.
TEST_F(SmokeViewTest, DimsAndVeilsBodiesByTheEquationOfSingleScattering) {
  constexpr double kNear = 0.025, kGreen = 0.86, kReach = 0.06;
  for (const double distance : {0.03, 0.05, 0.08}) {
    frame_.time += 1000;  // no smoke
    tissue_->setFrame(frame_);
    const double clear = ofBall(distance, 0.5), dark = ofBall(distance, 0);
    EXPECT_LT(dark, 1e-3);
    burn(6);
    const double extinction = test::graphicsScene().getFogDensity();
    ASSERT_NEAR(extinction, 6, 0.01);
    const double veil = ofBall(distance, 0), veiled = ofBall(distance, 0.5);
    EXPECT_TRUE(is_bluish_);
    double sum = 0;
    constexpr int kParts = 10000;
    for (int k = 0; k < kParts; ++k) {
      const double r = distance * (k + 0.5) / kParts;
      sum += distance / kParts * std::exp(-2 * extinction * r) / (r * r + kNear * kNear);
    }
    const double exact = kGreen * extinction / 4 * kReach * kReach * sum;
    std::printf("%.0f mm: %.3f of the light, veil %.3f, exact %.3f\n", 1e3 * distance, (veiled - veil) / clear, veil,
                exact);
    EXPECT_NEAR((veiled - veil) / clear, std::exp(-2 * extinction * distance), 0.02);
    EXPECT_NEAR(veil, exact, 0.06 * exact);  // one point of the integral
  }
}

TEST_F(SmokeViewTest, MarksGoFromWhiteOverTanToBrown) {
  const Eigen::Isometry3d pose = at(0.07), elsewhere = at(0.07, true);
  const std::vector<float> rest = organ_.places();
  for (std::size_t i = 0; i < frame_.grade.size(); ++i)
    if (std::hypot(rest[3 * i], rest[3 * i + 1]) < 0.01F && rest[3 * i + 2] > 0) frame_.grade[i] = 1;
  wait(0);
  const Pixels bare = picture(elsewhere);
  double light = 1e9, saturation = 0;
  for (const double step : {0.0, 60.0, 180.0, 240.0, 420.0}) {
    wait(step);
    const Eigen::Vector3d colour = middle(picture(pose));
    const double now_light = colour.dot(Eigen::Vector3d(0.299, 0.587, 0.114));
    const double now_saturation = (colour[0] - colour[2]) / colour[0];
    std::printf("after %.0f s: %.0f %.0f %.0f\n", frame_.time, colour[0], colour[1], colour[2]);
    EXPECT_LT(now_light, light - 8);
    EXPECT_GT(now_saturation, saturation + 0.02);
    light = now_light, saturation = now_saturation;
    EXPECT_TRUE(picture(elsewhere) == bare);  // control: the wall without marks
  }
  EXPECT_EQ(frame_.time, 900);
}

TEST_F(SmokeViewTest, FoldsFollowEachFrameThatIsLookedAt) {
  const auto frameOf = [this](double wider) {
    frame_.positions = organ_.places(wider);
    return frame_;
  };
  tissue_->setFrame(frameOf(1.0));
  const Pixels folded = picture(along());
  tissue_->setFrame(frameOf(1.15));
  tissue_->setFrame(frameOf(1.06));
  const Pixels followed = picture(along());
  EXPECT_FALSE(followed == folded);  // control
  tissue_->setMesh(organ_.mesh());
  tissue_->setFrame(frameOf(1.06));
  EXPECT_TRUE(picture(along()) == followed);
}

TEST_F(SmokeViewTest, ValuesForTheEndoscopeAreAskedForOnlyByItsScheme) {
  Ogre::MaterialPtr material = copyMaterial("vibe/tissue_inside");
  auto mesh = std::make_unique<DynamicMesh>(*test::graphicsScene().getRootSceneNode(),
                                            std::vector<Ogre::MaterialPtr>{material});
  const TissueMesh tube = organ_.mesh();
  mesh->setTopology(tube.triangles, tube.vertex_count, tube.rest);
  mesh->setBounds(Ogre::AxisAlignedBox::BOX_INFINITE);
  int asked = 0;
  mesh->beforeEndoscope([&] { ++asked; });
  const Ogre::TexturePtr texture = Ogre::TextureManager::getSingleton().createManual(
      uniqueName("Plain"), kResourceGroup, Ogre::TEX_TYPE_2D, 32, 32, 0, Ogre::PF_BYTE_RGB, Ogre::TU_RENDERTARGET);
  Ogre::Camera* plain = test::graphicsScene().createCamera(uniqueName("Plain"));
  test::graphicsScene().getRootSceneNode()->createChildSceneNode()->attachObject(plain);
  Ogre::RenderTarget& target = *texture->getBuffer()->getRenderTarget();
  target.addViewport(plain);
  target.update();
  EXPECT_EQ(asked, 0);
  picture(along());
  EXPECT_GT(asked, 0);  // control
  target.removeAllViewports();
  test::graphicsScene().destroyCamera(plain);
  Ogre::TextureManager::getSingleton().remove(texture);
  mesh.reset();
  dropMaterial(material);
}

}  // namespace
}  // namespace vibe::graphics::smoke_view_test
