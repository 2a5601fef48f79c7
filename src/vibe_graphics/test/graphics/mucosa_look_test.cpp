// Mucosa of other stomachs: what each quantity of MucosaLook does to the picture. Needs no display.
#include "vibe_graphics/geometry/mucosa_pattern.hpp"

#include <OgreSceneManager.h>
#include <gtest/gtest.h>

#include <cmath>

#include "vibe_graphics/graphics/offscreen_camera.hpp"
#include "vibe_graphics/graphics/tissue_visual.hpp"
#include "vibe_graphics/testing/graphics_scene.hpp"
#include "vibe_graphics/testing/tube_organ.hpp"

namespace vibe::graphics::mucosa_look_test {
namespace {

using test::Pixels;
constexpr int kSize = 200;  // [px]
constexpr double kWider = 1.06;

/// With a fixed exposure, from a place at x of the organ.
Pixels picture(const MucosaLook& look, double distance = 0.04, double x = 0, double wider = kWider) {
  TissueVisual tissue(*test::graphicsScene().getRootSceneNode(), look);
  test::TubeOrgan organ;
  organ.length = 0.4, organ.rows = 159;  // its ends are far away
  tissue.setMesh(organ.mesh());
  TissueFrame frame;
  frame.revision = 1;
  frame.positions = organ.places(wider);
  tissue.setFrame(frame);
  RoundCamera round;
  round.width = round.height = kSize;
  OffscreenCamera camera(test::graphicsScene(), round, 1);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translate(Eigen::Vector3d(x, 0, wider * organ.radius - distance));
  Pixels pixels;
  camera.take(pose, pixels);
  return pixels;
}

double difference(const Pixels& a, const Pixels& b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += std::abs(int{a[k]} - int{b[k]});
  return sum / static_cast<double>(a.size());
}

Eigen::Vector3d mean(const Pixels& pixels) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < pixels.size(); ++k) sum[static_cast<Eigen::Index>(k % 3)] += pixels[k];
  return sum / (static_cast<double>(pixels.size()) / 3);
}

// A straight tube is the same everywhere along x, so shifted patterns look as if the camera had moved.
TEST(MucosaLook, ShiftOfPatternsIsAMoveOfTheCameraAlongTheTube) {
  const double rows = 10 * 0.4 / 158;  // from vertex to vertex, so that the same places are interpolated
  MucosaLook shifted;
  shifted.shift.x() = static_cast<float>(rows);
  for (const double wider : {1.0, 1.15}) {  // folds, and a smooth wall
    const Pixels usual = picture({}, 0.04, 0, wider);
    const double same = difference(picture(shifted, 0.04, -rows, wider), usual);
    const double control = difference(picture(shifted, 0.04, 0, wider), usual);
    std::printf("%.0f %% wider: as from elsewhere %.2f, from the same place %.2f levels\n", 100 * (wider - 1), same,
                control);
    EXPECT_LT(same, 0.3);
    EXPECT_GT(control, 3);
  }
}

TEST(MucosaLook, ConstantsOfTheUsualShaderAreTheDefaults) {
  MucosaLook nearly;
  nearly.yellowness += 1e-12;  // another program, the same numbers
  ASSERT_FALSE(nearly.isUsual());
  EXPECT_TRUE(picture(nearly) == picture({}));
  nearly.yellowness += 1e-2;  // control
  EXPECT_FALSE(picture(nearly) == picture({}));
}

/// Changes between brighter and darker than the mean around, per row of the picture's middle.
double changes(const Pixels& pixels) {
  constexpr int kHalf = 16;
  int count = 0;
  for (int y = kSize / 2 - 40; y < kSize / 2 + 40; ++y) {
    bool before = false;
    for (int x = kSize / 2 - 50; x < kSize / 2 + 50; ++x) {
      double around = 0;
      for (int n = -kHalf; n <= kHalf; ++n) around += pixels[static_cast<std::size_t>(3 * (y * kSize + x + n) + 1)];
      const bool brighter = (2 * kHalf + 1) * pixels[static_cast<std::size_t>(3 * (y * kSize + x) + 1)] > around;
      if (x > kSize / 2 - 50 && brighter != before) ++count;
      before = brighter;
    }
  }
  return count / 80.0;
}

/// Mean over the same eight places of the pattern.
double changesOf(double areae_size) {
  double sum = 0;
  for (int k = 0; k < 8; ++k) {
    MucosaLook look;
    look.areae_size = areae_size;
    look.shift = static_cast<float>(k) * Eigen::Vector3f(0.037F, 0.021F, 0.053F);
    sum += changes(picture(look, 0.012, 0, 1.15)) / 8;
  }
  return sum;
}

TEST(MucosaLook, LargerAreaeAreFewer) {
  const double small = changesOf(2e-3), usual = changesOf(2.5e-3), large = changesOf(5e-3);
  const double nearly = changesOf(2.4e-3);
  std::printf("changes per row: areae of 2 mm %.1f, 2.4 mm %.1f, 2.5 mm %.1f, 5 mm %.1f\n", small, nearly, usual,
              large);
  EXPECT_GT(small, 1.08 * usual);
  EXPECT_GT(usual, 1.2 * large);
  EXPECT_NEAR(nearly / usual, 1, 0.06);  // control: another pattern of nearly the same size
}

TEST(MucosaLook, PaleAndYellowMucosaAreThat) {
  const Eigen::Vector3d usual = mean(picture({}));
  MucosaLook pale, yellow;
  pale.paleness = 1.25, yellow.yellowness = 1.09;
  const Eigen::Vector3d paler = mean(picture(pale)), yellower = mean(picture(yellow));
  EXPECT_GT(paler[1] / paler[0], 1.05 * usual[1] / usual[0]);
  EXPECT_GT(paler[2] / paler[0], 1.05 * usual[2] / usual[0]);
  EXPECT_NEAR(paler[2] / paler[1], usual[2] / usual[1], 0.02);  // control: not yellower
  EXPECT_GT(yellower[1] / yellower[2], 1.03 * usual[1] / usual[2]);
  EXPECT_NEAR(yellower[0], usual[0], 0.5);  // control: as red as before
}

TEST(MucosaLook, VesselsDarkenWetnessBrightensMucusSmooths) {
  const double wall = 1.15;
  const Pixels usual = picture({}, 0.04, 0, wall);
  MucosaLook vessels, wet, mucus;
  vessels.vessels = 2, wet.wetness = 1.6, mucus.mucus = 0.08;
  const auto green = [](const Pixels& pixels) { return mean(pixels)[1]; };
  EXPECT_LT(green(picture(vessels, 0.04, 0, wall)), green(usual) - 0.1);
  EXPECT_GT(green(picture(wet, 0.04, 0, wall)), green(usual) + 0.1);
  const double film = difference(picture(mucus, 0.04, 0, wall), usual);
  std::printf("green %.2f, vessels %.2f, wet %.2f; mucus changes by %.2f levels\n", green(usual),
              green(picture(vessels, 0.04, 0, wall)), green(picture(wet, 0.04, 0, wall)), film);
  EXPECT_GT(film, 0.3);
  EXPECT_TRUE(picture({}, 0.04, 0, wall) == usual);  // control: the same look
}

}  // namespace
}  // namespace vibe::graphics::mucosa_look_test
