// Where and how large markers are drawn: noise-free pictures against forward projection of the designs.
#include "synthetic/surface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "synthetic/forward_picture.hpp"
#include "synthetic/picture_moments.hpp"

namespace vibe::vision::surface_test {
namespace {

constexpr double kDegree = M_PI / 180;

ForwardPicture forwardOf(const SyntheticScene& scene, double time = 0) {
  const SyntheticInstrument& object = scene.instruments[0];
  const MarkerFrame frame = markerFrame(scene.camera, object, time);
  const double fine = 5e-6;  // [m]; 0.05 px: bars begin and end between two points
  if (const auto* ring = std::get_if<RingDesign>(&object.nominal.marker))
    return forwardPicture(scene.camera, *ring, frame, Eigen::Vector2d::Constant(ring->outer_diameter / 2 + fine),
                          {fine, fine});
  const auto& sleeve = std::get<SleeveDesign>(object.nominal.marker);
  return forwardPicture(scene.camera, sleeve, frame, {sleeve.length / 2, 0.55 * M_PI},
                        {fine, 2 * fine / sleeve.diameter});
}

/// Slides that put the markers' centres at different parts of a pixel.
const std::vector<double> kSlides = {-0.0199873, 1.37e-5, 0.0123481, 0.0200226};

/// The picture through the pixels' apertures only, moved along and across [m].
std::vector<double> sharpPicture(SyntheticScene scene, double along, double across) {
  scene.degradation.blur = 0;
  const auto slide = scene.instruments[0].motion.slide;
  scene.instruments[0].motion.slide = [slide, along](double time) { return slide(time) + along; };
  scene.instruments[0].lateral += across;
  return blackPart(scene, 0);
}

/// By how much the drawn marker is beside its true place, as least squares sees it [px].
Eigen::Vector2d displacement(const SyntheticScene& scene, const ForwardPicture& truth) {
  constexpr double kStep = 5e-6;
  const double pixels = 2 * kStep * scene.instruments[0].nominal.axis.pixels_per_metre;
  const std::vector<double> drawn = sharpPicture(scene, 0, 0);
  const std::vector<double> right = sharpPicture(scene, kStep, 0), left = sharpPicture(scene, -kStep, 0);
  const std::vector<double> below = sharpPicture(scene, 0, kStep), above = sharpPicture(scene, 0, -kStep);
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    const Eigen::Vector2d gradient((right[i] - left[i]) / pixels, (below[i] - above[i]) / pixels);
    normal += gradient * gradient.transpose();
    moment += gradient * (drawn[i] - truth.black[i]);
  }
  return normal.inverse() * moment;
}

void expectSamePlace(const SyntheticScene& scene) {
  const ForwardPicture truth = forwardOf(scene);
  EXPECT_LT(displacement(scene, truth).norm(), 1e-3) << displacement(scene, truth).transpose();
  const Moments drawn = momentsOf(blackPart(scene, 0), scene.camera.width);
  EXPECT_LT((drawn.centroid - truth.centroid).norm(), 4e-3);
  EXPECT_NEAR(drawn.area / truth.area, 1, 1e-3);
}

TEST(Surface, CentroidOfARingIsTheTruth) {
  for (const double slide : kSlides) {
    SyntheticScene scene = restingScene(1, slide);
    scene.instruments[0].nominal.axis.perspective = 0;  // parallel to the sensor: the picture is a circle
    const Moments drawn = momentsOf(blackPart(scene, 0), scene.camera.width);
    const Eigen::Vector2d truth = truthAt(scene, 0, 0).pixel;
    EXPECT_NEAR(drawn.centroid.x(), truth.x(), 5e-4) << slide;
    EXPECT_NEAR(drawn.centroid.y(), truth.y(), 5e-4) << slide;
    const double area = M_PI / 4 * (40 * 40 - 20 * 20);
    EXPECT_NEAR(drawn.area, area, 2e-3 * area) << slide;
  }
}

TEST(Surface, RingsAreWhereForwardProjectionPutsThem) {
  for (const double slide : kSlides) expectSamePlace(restingScene(1, slide));
}

TEST(Surface, SleevesAreWhereForwardProjectionPutsThem) {
  for (const double slide : kSlides) expectSamePlace(restingScene(0, slide, 100 * slide));
}

TEST(Surface, TheComparisonSeesAHundredthOfAPixel) {
  SyntheticScene scene = restingScene(0, 0.0123481, 1.2);
  const ForwardPicture truth = forwardOf(scene);
  scene.instruments[0].motion.slide = [](double) { return 0.0123481 + 1e-6; };
  scene.instruments[0].lateral -= 1e-6;
  const Eigen::Vector2d seen = displacement(scene, truth);
  EXPECT_NEAR(seen.x(), 0.01, 1e-3);
  EXPECT_NEAR(seen.y(), -0.01, 1e-3);
}

TEST(Surface, ThroughADistortingLensToo) {
  for (const std::size_t instrument : {0, 1}) {
    SyntheticScene scene = restingScene(instrument, instrument == 0 ? -0.0199873 : 0.0200226, 1);
    const Eigen::Vector2d straight = truthAt(scene, 0, 0).pixel;
    bendLens(scene);
    EXPECT_GT((truthAt(scene, 0, 0).pixel - straight).norm(), 1);
    expectSamePlace(scene);
  }
}

TEST(Surface, TiltSlantScaleAndLateralOffset) {
  for (const std::size_t instrument : {0, 1}) {
    SyntheticScene scene = restingScene(instrument, 0.015, 2.5);
    scene.instruments[0].tilt = 15 * kDegree;
    scene.instruments[0].slant = -15 * kDegree;
    scene.instruments[0].scale = 1.1;
    scene.instruments[0].lateral = 4e-4;
    expectSamePlace(scene);
  }
}

TEST(Surface, RotationOfTheRodFollowsTheRightHand) {
  // A point of the print at phi is seen at lateral = radius sin(phi + r), to the right of the direction: below.
  SleeveDesign sleeve = defaultSleeve();
  sleeve.bars.clear();
  sleeve.helix_begin = -0.0005;
  sleeve.helix_end = 0.0005;
  sleeve.helix_pitch = 1;  // a stripe along the rod, from phi = -18 to 18 degrees
  sleeve.helix_duty = 0.1;
  SyntheticScene scene = restingScene(0, 0, 30 * kDegree);
  scene.instruments[0].nominal.marker = sleeve;
  scene.instruments[0].nominal.axis.direction = {1, 0};
  scene.instruments[0].lateral = 0;
  const Moments drawn = momentsOf(blackPart(scene, 0), scene.camera.width);
  const double weighted = (std::pow(std::sin(48 * kDegree), 2) - std::pow(std::sin(12 * kDegree), 2)) / 2 /
                          (std::sin(48 * kDegree) - std::sin(12 * kDegree));
  EXPECT_NEAR(drawn.centroid.y() - scene.instruments[0].nominal.axis.origin.y(), 15 * weighted, 0.1);
}

TEST(Surface, EveryPixelOfAMarkerIsRight) {
  for (const std::size_t instrument : {0, 1}) {
    SyntheticScene scene = restingScene(instrument, 0.0173, 0.7);
    bendLens(scene);
    scene.instruments[0].tilt = -6 * kDegree;
    scene.instruments[0].slant = 10 * kDegree;
    const std::vector<double> truth = forwardOf(scene).black;
    const auto most = [&](const std::vector<double>& drawn) {
      double largest = 0;
      for (std::size_t i = 0; i < drawn.size(); ++i) largest = std::max(largest, std::abs(drawn[i] - truth[i]));
      return largest;
    };
    EXPECT_LT(most(sharpPicture(scene, 0, 0)), 0.08);  // the forward picture is made of points, 0.05 px apart
    EXPECT_GT(most(sharpPicture(scene, 0, 2e-5)), 0.15);
  }
}

TEST(Surface, TagsShowTheirCells) {
  SyntheticScene scene = restingScene(1, 0.0031);
  SyntheticTag tag;
  tag.cells = 4;
  tag.white = {0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0};
  scene.instruments[0].tag = tag;
  scene.instruments[0].tilt = 10 * kDegree;
  const std::vector<double> black = blackPart(scene, 0);
  const MarkerFrame frame = markerFrame(scene.camera, scene.instruments[0], 0);
  for (int row = -1; row <= 4; ++row)
    for (int column = -1; column <= 4; ++column) {
      const bool inside = row >= 0 && column >= 0 && row < 4 && column < 4;
      const bool white = !inside || tag.white[static_cast<std::size_t>(4 * row + column)] != 0;
      const Eigen::Vector3d middle = frame.centre + 1e-3 * ((column - 1.5) * frame.along + (row - 1.5) * frame.across);
      const Eigen::Vector2d pixel = project(scene.camera, middle);
      const auto at = static_cast<std::size_t>(std::lround(pixel.y()) * scene.camera.width + std::lround(pixel.x()));
      EXPECT_NEAR(black[at], white ? 0 : 1, 1e-3) << row << ' ' << column;
    }
  EXPECT_NEAR(momentsOf(black, scene.camera.width).area, 1300, 3);
}

TEST(AxisLine, ItsPictureIsTheCalibratedAxis) {
  for (const double perspective : {-0.4, 0.0, 0.25}) {
    SyntheticScene scene = restingScene(0, 0);
    CameraModel& camera = scene.camera;
    camera.fy = 4700;
    SlideAxis axis = scene.instruments[0].nominal.axis;
    axis.direction = {std::cos(1.1), std::sin(1.1)};
    axis.perspective = perspective;
    const AxisLine line = axisLine(camera, axis);
    EXPECT_NEAR(line.direction.norm(), 1, 1e-12);
    for (const double slide : {-0.02, 0.0, 0.013}) {
      const Eigen::Vector2d expected = axis.origin + alongOf(axis, slide) * axis.direction;
      EXPECT_LT((projectIdeal(camera, line.origin + slide * line.direction) - expected).norm(), 1e-9);
    }
  }
}

}  // namespace
}  // namespace vibe::vision::surface_test
