// Light guides of other endoscopes, on a flat wall: every pixel against the equation in media/lamp.glsl. Needs no
// display.
#include "vibe_graphics/graphics/endoscope_lamp.hpp"

#include <OgreSceneManager.h>
#include <OgreTechnique.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "vibe_graphics/geometry/solid_bodies.hpp"
#include "vibe_graphics/graphics/offscreen_camera.hpp"
#include "vibe_graphics/graphics/shape_visual.hpp"
#include "vibe_graphics/graphics/tissue_visual.hpp"
#include "vibe_graphics/testing/graphics_scene.hpp"
#include "vibe_graphics/testing/tube_organ.hpp"

namespace vibe::graphics::endoscope_lamp_test {
namespace {

using test::Pixels;
constexpr int kSize = 160;                                  // [px]
constexpr double kHalfAngle = 0.9;                          // of the picture [rad]
constexpr double kReach = 0.06, kNear = 0.04, kSoft = 0.1;  // as in media/solid.frag
constexpr double kGloss = 0.3;

EndoscopeLight oddLight() {
  EndoscopeLight light;
  light.guides = {{{0.0070, 0.0040, 1.4}, {-0.0110, -0.0020, 0.5}}};
  light.sideward = 0.6;
  light.temperature = 4800;
  return light;
}

class EndoscopeLampTest : public ::testing::Test {
 protected:
  void SetUp() override {
    material_ = (test::graphicsScene(), copyMaterial("vibe/solid"));
    wall_ = std::make_unique<ShapeView>(*test::graphicsScene().getRootSceneNode(), material_);
  }
  void TearDown() override {
    setLamp({});
    wall_.reset();
    dropMaterial(material_);
  }

  /// A wall across the view [m]; white, or black and dull.
  void showWall(double distance, bool white) {
    for (Ogre::Technique* technique : material_->getTechniques())
      technique->getPass(0)->getFragmentProgramParameters()->setNamedConstant("gloss",
                                                                              static_cast<float>(white ? kGloss : 0));
    ColouredShape shape;
    const double grey = white ? 1 : 0;
    appendBox(Eigen::Isometry3d(Eigen::Translation3d(0, 0, distance + 0.005)), {0.6, 0.6, 0.01},
              packed(grey, grey, grey), shape);
    wall_->show(shape);
  }

  /// With a fixed exposure.
  static Pixels picture(const EndoscopeLight& light) {
    setLamp(light);
    OffscreenCamera camera(test::graphicsScene(), {LensKind::Rectilinear, 2 * kHalfAngle, kSize, kSize}, 1);
    Pixels pixels;
    camera.take(Eigen::Isometry3d::Identity(), pixels);
    return pixels;
  }

  /// media/endoscope.frag turned around.
  static double radianceOf(std::uint8_t level) {
    return -std::log(1 - std::pow(level / 255.0, 1 / 0.6)) / AutoExposure::kFixedGain;
  }

  static int halfOf(const Pixels& pixels, bool left) {
    int sum = 0;
    for (int y = kSize / 4; y < 3 * kSize / 4; ++y)
      for (int x = 0; x < kSize / 4; ++x)
        sum += pixels[static_cast<std::size_t>(3 * (y * kSize + (left ? kSize / 4 + x : kSize / 2 + x)) + 1)];
    return sum;
  }

  std::unique_ptr<ShapeView> wall_;
  Ogre::MaterialPtr material_;
};

/// Level of a white wall at this distance, 0 to 255. Right and up of the middle in tangents.
Eigen::Vector3d levelAt(const EndoscopeLight& light, double distance, double right, double up) {
  const Eigen::Vector3d place(right * distance, up * distance, -distance), normal(0, 0, 1);
  double sum = 0.05 * kReach * kReach / (place.squaredNorm() + 4e-4);
  for (const LightGuide& guide : light.guides) {
    const Eigen::Vector3d way = Eigen::Vector3d(guide.right, guide.up, 0) - place, to_lamp = way.normalized();
    const double power = guide.strength * 0.5 * (light.sideward + (1 - light.sideward) * to_lamp.z()) * kReach *
                         kReach / (way.squaredNorm() + kNear * kNear);
    const double mirrored = normal.dot((to_lamp - place.normalized()).normalized());
    sum += power * ((to_lamp.z() + kSoft) / (1 + kSoft) +
                    kGloss * (0.5 * std::pow(mirrored, 256) + 0.5 * std::pow(mirrored, 32)));
  }
  const Eigen::Vector3d radiance = sum * lightColour(light.temperature);
  return radiance.unaryExpr([](double r) { return 255 * std::pow(1 - std::exp(-AutoExposure::kFixedGain * r), 0.6); });
}

/// Largest difference of a picture to the equation, where it is not at the rim [levels].
double largestError(const Pixels& pixels, const EndoscopeLight& light, double distance) {
  double largest = 0;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const double right = (2 * x + 1.0 - kSize) / kSize, up = -(2 * y + 1.0 - kSize) / kSize;
      if (std::hypot(right, up) > 0.9) continue;
      const Eigen::Vector3d level = levelAt(light, distance, right * std::tan(kHalfAngle), up * std::tan(kHalfAngle));
      for (int c = 0; c < 3; ++c)
        largest = std::max(largest, std::abs(level[c] - pixels[static_cast<std::size_t>(3 * (y * kSize + x) + c)]));
    }
  return largest;
}

TEST_F(EndoscopeLampTest, EveryPixelOfAWallIsAsTheEquationSays) {
  for (const double distance : {0.02, 0.04, 0.08}) {
    showWall(distance, true);
    const double usual = largestError(picture({}), {}, distance);
    const Pixels odd = picture(oddLight());
    std::printf("%.0f mm: %.2f levels, other light %.2f, its picture as with the usual light %.1f\n", 1e3 * distance,
                usual, largestError(odd, oddLight(), distance), largestError(odd, {}, distance));
    EXPECT_LT(usual, 1.5);
    EXPECT_LT(largestError(odd, oddLight(), distance), 1.5);
    EXPECT_GT(largestError(odd, {}, distance), 10);  // control
    EndoscopeLight mirrored = oddLight();            // control: left and right, up and down exchanged
    for (LightGuide& guide : mirrored.guides) guide.right = -guide.right, guide.up = -guide.up;
    EXPECT_GT(largestError(odd, mirrored, distance), 3);
  }
}

/// A smooth organ of mucosa.
struct Tube {
  TissueVisual tissue{*test::graphicsScene().getRootSceneNode()};
  test::TubeOrgan organ;

  Tube() {
    tissue.setMesh(organ.mesh());
    TissueFrame frame;
    frame.revision = 1;
    frame.positions = organ.places(kWider);
    tissue.setFrame(frame);
  }

  /// Of a lens that looks at the middle of the wall from this distance [m].
  Eigen::Isometry3d before(double distance) const {
    return Eigen::Isometry3d(Eigen::Translation3d(0, 0, kWider * organ.radius - distance));
  }

  static constexpr double kWider = 1.15;  // than at rest, where it has folds
};

TEST_F(EndoscopeLampTest, MucosaIsBrighterOnTheSideOfItsGuide) {
  const Tube tube;
  const Eigen::Isometry3d pose = tube.before(0.012);
  const auto shareOfLeft = [&](double right_guide, double left_guide) {
    EndoscopeLight light;
    light.guides[0].strength = right_guide, light.guides[1].strength = left_guide;
    setLamp(light);
    OffscreenCamera camera(test::graphicsScene(), {LensKind::Rectilinear, 2 * kHalfAngle, kSize, kSize}, 1);
    Pixels pixels;
    camera.take(pose, 1, pixels);
    return static_cast<double>(halfOf(pixels, true)) / halfOf(pixels, false);
  };
  const double left = shareOfLeft(0, 2), both = shareOfLeft(1, 1), right = shareOfLeft(2, 0);
  std::printf("left half to right half: left guide %.3f, both %.3f, right guide %.3f\n", left, both, right);
  EXPECT_GT(left, 1.05 * both);
  EXPECT_LT(right, 0.95 * both);
  EXPECT_NEAR(both, 1, 0.05);  // control: what the pattern of the wall does
}

/// What a picture consists of (ratios), and its mean colour (levels).
struct Mixture {
  double black = 0, white = 0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  double redness() const { return mean[0] / mean[1]; }
};

Mixture mixtureOf(const Pixels& pixels) {
  Mixture mixture;
  int count = 0;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      if (std::hypot(2 * x + 1 - kSize, 2 * y + 1 - kSize) > 0.96 * kSize) continue;
      const std::uint8_t* pixel = &pixels[static_cast<std::size_t>(3 * (y * kSize + x))];
      const int sum = pixel[0] + pixel[1] + pixel[2];
      mixture.black += sum < 15 ? 1 : 0;
      mixture.white += sum > 735 ? 1 : 0;
      ++count;
      for (int c = 0; c < 3; ++c) mixture.mean[c] += pixel[c];
    }
  mixture.black /= count, mixture.white /= count, mixture.mean /= count;
  return mixture;
}

TEST_F(EndoscopeLampTest, AWallThatIsTouchedIsRedAndNeverBlack) {
  const Tube tube;
  const auto seenFrom = [&](double distance) {  // below 0: the wall is behind the lens
    OffscreenCamera camera(test::graphicsScene(), {LensKind::Equidistant, 2.44, kSize, kSize}, 1);
    Pixels pixels;
    camera.take(tube.before(distance), 1, pixels);
    return mixtureOf(pixels);
  };
  const double far = seenFrom(0.030).redness();
  double last = far;
  for (const double distance : {0.010, 0.006, 0.003, 0.0015, 0.0008, 0.0003, 0.0001, -0.0003, -0.002}) {
    const Mixture seen = seenFrom(distance);
    std::printf("%5.1f mm: black %.3f, white %.3f, red to green %.2f\n", 1e3 * distance, seen.black, seen.white,
                seen.redness());
    EXPECT_LT(seen.black, 0.01) << distance;
    EXPECT_LT(seen.white, 0.05) << distance;
    EXPECT_GT(seen.redness(), 0.93 * last) << distance;  // never much less than from farther away
    last = seen.redness();
  }
  EXPECT_GT(seenFrom(0.0008).redness(), 1.3 * far);
  EXPECT_GT(seenFrom(0.0003).redness(), 1.6 * far);
  EXPECT_GT(seenFrom(-0.007).black, 0.9);  // control: a lens that is outside sees nothing
}

TEST_F(EndoscopeLampTest, SmokeIsLitByTheSameGuides) {
  SceneSmoke smoke(test::graphicsScene());
  smoke.set(6, 0);
  showWall(0.06, false);
  EndoscopeLight more;
  more.guides[0].strength = 0.9, more.guides[1].strength = 0.5;
  const Pixels usual = picture({}), dimmed = picture(more);
  for (const int x : {kSize / 4, kSize / 2, 2 * kSize / 3}) {
    const auto pixel = static_cast<std::size_t>(3 * (kSize / 2 * kSize + x) + 1);
    EXPECT_GT(usual[pixel], 60);
    EXPECT_NEAR(radianceOf(dimmed[pixel]) / radianceOf(usual[pixel]), 0.7, 0.03) << x;  // a level is 1 %
  }
  smoke.set(0, 0);
  EXPECT_LT(picture({})[3 * (kSize / 2 * kSize + kSize / 2) + 1], 20);  // control: without smoke there is no light
}

TEST_F(EndoscopeLampTest, PlacesAreThoseOfTheLight) {
  setLamp(oddLight());
  EXPECT_EQ(guidePlaces()[0], Ogre::Vector3(0.0070F, 0.0040F, 0));
  EXPECT_EQ(guidePlaces()[1], Ogre::Vector3(-0.0110F, -0.0020F, 0));
  setLamp({});
  EXPECT_EQ(guidePlaces()[1], Ogre::Vector3(-0.0035F, 0.0012F, 0));
}

}  // namespace
}  // namespace vibe::graphics::endoscope_lamp_test
