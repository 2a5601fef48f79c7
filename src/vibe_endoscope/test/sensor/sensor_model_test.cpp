// What the sensor does to flat images and to a line: its statistics against their formulas.

#include "sensor/sensor_model.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace vibe::endoscope::sensor_model_test {
namespace {

using Pixels = std::vector<std::uint8_t>;

graphics::RoundCamera smallCamera(graphics::LensKind lens = graphics::LensKind::Equidistant) {
  graphics::RoundCamera camera;
  camera.lens = lens;
  camera.width = 160, camera.height = 120;
  if (lens == graphics::LensKind::Rectilinear) camera.field_of_view = 1.6;
  return camera;
}

Pixels flat(std::uint8_t value) {
  return Pixels(3 * 160 * 120, value);
}

double light(double value) {
  const double v = value / 255;
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

struct Statistics {
  double mean = 0, deviation = 0, between = 0;  // of the light; correlation of neighbours
};

/// Of the square in the middle of the circle.
Statistics statisticsOf(const Pixels& pixels) {
  Statistics result;
  double sum = 0, squares = 0, products = 0;
  int count = 0;
  for (int y = 30; y < 90; ++y)
    for (int x = 50; x < 110; ++x)
      for (int c = 0; c < 3; ++c) {
        const double value = light(pixels[static_cast<std::size_t>(3 * (160 * y + x) + c)]);
        const double next = light(pixels[static_cast<std::size_t>(3 * (160 * y + x + 1) + c)]);
        sum += value, squares += value * value, products += value * next, ++count;
      }
  result.mean = sum / count;
  result.deviation = std::sqrt(squares / count - result.mean * result.mean);
  result.between = (products / count - result.mean * result.mean) / (result.deviation * result.deviation);
  return result;
}

TEST(SensorModel, PlainStyleChangesNothing) {
  Pixels pixels = flat(0);
  for (std::size_t k = 0; k < pixels.size(); ++k) pixels[k] = static_cast<std::uint8_t>(k * 7);
  const Pixels before = pixels;
  SensorModel(SensorStyle(), smallCamera()).expose(pixels, 1);
  EXPECT_TRUE(pixels == before);
}

TEST(SensorModel, EveryLevelSurvivesTheWayThroughLight) {
  SensorStyle style;
  style.vignetting = 1e-12;  // not plain, but without effect
  for (int value = 0; value < 256; ++value) {
    Pixels pixels = flat(static_cast<std::uint8_t>(value));
    SensorModel(style, smallCamera()).expose(pixels, 1);
    EXPECT_EQ(int{pixels[3 * (160 * 60 + 80)]}, value);
    EXPECT_EQ(int{pixels[0]}, 0);  // outside of the circle
  }
}

TEST(SensorModel, NoiseHasTheVarianceOfPhotonsAndReading) {
  for (const int value : {60, 120, 180}) {
    SensorStyle style;
    style.full_well = 800, style.read_noise = 0.01;
    Pixels pixels = flat(static_cast<std::uint8_t>(value));
    SensorModel(style, smallCamera()).expose(pixels, 3);
    const Statistics found = statisticsOf(pixels);
    const double expected = std::sqrt(light(value) / 800 + 1e-4);
    EXPECT_NEAR(found.mean, light(value), 4 * expected / std::sqrt(10800.0) + 1e-3) << value;
    EXPECT_NEAR(found.deviation, expected, 0.04 * expected) << value;
    EXPECT_NEAR(found.between, 0, 0.04) << value;  // white
  }
}

TEST(SensorModel, NoiseRepeatsWithSeedAndNumberOnly) {
  SensorStyle style;
  style.read_noise = 0.05;
  const auto shot = [&](std::uint32_t seed, std::uint64_t number) {
    style.seed = seed;
    Pixels pixels = flat(120);
    SensorModel(style, smallCamera()).expose(pixels, number);
    return pixels;
  };
  EXPECT_TRUE(shot(1, 5) == shot(1, 5));
  EXPECT_FALSE(shot(1, 5) == shot(2, 5));
  EXPECT_FALSE(shot(1, 5) == shot(1, 6));
}

TEST(SensorModel, ExposureAndVignettingAreFactorsOnTheLight) {
  SensorStyle style;
  style.exposure = 0.5, style.vignetting = 0.4;
  Pixels pixels = flat(200);
  SensorModel(style, smallCamera()).expose(pixels, 1);
  const double step = light(200) - light(199);
  EXPECT_NEAR(light(pixels[3 * (160 * 60 + 80)]), 0.5 * light(200), step);
  const double aside = 29.5 / 60;  // of the radius
  EXPECT_NEAR(light(pixels[3 * (160 * 60 + 109)]), 0.5 * light(200) * (1 - 0.4 * aside * aside), step);
  EXPECT_NEAR(light(pixels[3 * (160 * 60 + 138)]), 0.5 * light(200) * 0.62, 2 * step);
}

TEST(SensorModel, BlurSpreadsALineByItsStandardDeviationAndKeepsTheLight) {
  SensorStyle style;
  style.blur = 1.5;
  Pixels pixels = flat(0);
  for (int y = 0; y < 120; ++y)
    for (int c = 0; c < 3; ++c) pixels[static_cast<std::size_t>(3 * (160 * y + 80) + c)] = 255;
  SensorModel(style, smallCamera()).expose(pixels, 1);
  double sum = 0, squares = 0;
  for (int x = 60; x < 100; ++x) {
    const double value = light(pixels[static_cast<std::size_t>(3 * (160 * 60 + x))]);
    sum += value, squares += value * (x - 80) * (x - 80);
  }
  EXPECT_NEAR(sum, 1, 0.02);
  EXPECT_NEAR(std::sqrt(squares / sum), 1.5, 0.05);
}

// The image of a bright spot moves to where the model says, and the model is undone by its inverse.
TEST(SensorModel, DistortionMovesPointsAsTheModelOfTheLensSays) {
  for (const graphics::LensKind lens : {graphics::LensKind::Equidistant, graphics::LensKind::Rectilinear})
    for (const double k1 : {-0.08, 0.1}) {
      SensorStyle style;
      style.distortion = k1;
      const graphics::RoundCamera camera = smallCamera(lens);
      ASSERT_EQ(problemOf(style, camera), "");
      const Eigen::Vector2d spot(110, 76), there = distorted(style, camera, spot);
      EXPECT_LT((undistorted(style, camera, there) - spot).norm(), 1e-9);
      const double slope = (spot - camera.middle()).norm() / graphics::focalLength(camera);
      const double expected = graphics::focalLength(camera) * (slope + k1 * slope * slope * slope);
      EXPECT_NEAR((there - camera.middle()).norm(), expected, 1e-9);
      Pixels pixels = flat(0);
      for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) pixels[static_cast<std::size_t>(3 * (160 * (76 + y) + 110 + x))] = 255;
      SensorModel(style, camera).expose(pixels, 1);
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (int y = 0; y < 120; ++y)
        for (int x = 0; x < 160; ++x)
          sum += light(pixels[static_cast<std::size_t>(3 * (160 * y + x))]) * Eigen::Vector3d(x, y, 1);
      EXPECT_LT((sum.head<2>() / sum.z() - there).norm(), 0.1) << k1;
      EXPECT_GT((sum.head<2>() / sum.z() - spot).norm(), 0.3) << k1;  // control: it has moved
    }
}

TEST(SensorModel, DistortionThatFoldsTheImageOverIsRefused) {
  SensorStyle style;
  style.distortion = -0.2;
  graphics::RoundCamera camera = smallCamera(graphics::LensKind::Rectilinear);
  camera.field_of_view = 2.4;
  EXPECT_NE(problemOf(style, camera), "");
  style.distortion = 0.2;
  EXPECT_EQ(problemOf(style, camera), "");
}

}  // namespace
}  // namespace vibe::endoscope::sensor_model_test
