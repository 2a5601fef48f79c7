#include "vibe_graphics/geometry/endoscope_optics.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace vibe::graphics::lens_test {
namespace {

constexpr double kDegree = M_PI / 180;

RoundCamera camera(LensKind lens, double degrees = 140, int width = 640, int height = 480) {
  return {lens, degrees * kDegree, width, height};
}

class BothLenses : public ::testing::TestWithParam<LensKind> {};
INSTANTIATE_TEST_SUITE_P(Lens, BothLenses, ::testing::Values(LensKind::Equidistant, LensKind::Rectilinear));

TEST_P(BothLenses, PixelToRayAndBackIsTheSamePixel) {
  const RoundCamera round = camera(GetParam());
  for (double x = -3; x < 643; x += 29.3)
    for (double y = -2; y < 482; y += 23.7) {
      const Eigen::Vector3d ray = rayOf(round, {x, y});
      ASSERT_NEAR(ray.norm(), 1, 1e-12);
      ASSERT_LT((pixelOf(round, 0.07 * ray) - Eigen::Vector2d(x, y)).norm(), 1e-8) << x << " " << y;
    }
}

TEST_P(BothLenses, CircleTouchesTheNearerEdgesAndIsHalfTheFieldOfViewFromTheAxis) {
  for (const double degrees : {10., 90., 140., 170.}) {
    const RoundCamera round = camera(GetParam(), degrees, 641, 480);
    // outer edges of the first and last row of pixels
    for (const double y : {-0.5, 479.5})
      EXPECT_NEAR(std::acos(rayOf(round, {320, y}).z()), 0.5 * degrees * kDegree, 1e-9);
    EXPECT_NEAR(angleAt(round, 240), 0.5 * degrees * kDegree, 1e-12);
    EXPECT_NEAR(radiusAt(round, 0.5 * degrees * kDegree), 240, 1e-9);
  }
}

TEST_P(BothLenses, CentreIsTheAxisAndItsScaleIsTheFocalLengthPerRadian) {
  const RoundCamera round = camera(GetParam());
  EXPECT_LT((pixelOf(round, {0, 0, 0.1}) - round.middle()).norm(), 1e-12);
  EXPECT_LT((rayOf(round, round.middle()) - Eigen::Vector3d::UnitZ()).norm(), 1e-12);
  const double tiny = 1e-6;
  EXPECT_NEAR(radiusAt(round, tiny) / tiny, focalLength(round), 1e-6 * focalLength(round));
}

TEST_P(BothLenses, RightOfTheAxisIsRightInThePictureAndBelowIsBelow) {
  const RoundCamera round = camera(GetParam());
  const Eigen::Vector2d pixel = pixelOf(round, {0.01, 0.02, 0.05});
  EXPECT_GT(pixel.x(), round.middle().x());
  EXPECT_GT(pixel.y(), round.middle().y());
  EXPECT_NEAR((pixel - round.middle()).y() / (pixel - round.middle()).x(), 2, 1e-12);
}

TEST_P(BothLenses, NumbersOfCameraInfoProjectAsThePictureDoes) {
  const RoundCamera round = camera(GetParam(), 120, 500, 700);
  const CameraNumbers numbers = numbersOf(round, 0);
  for (const double value : numbers.d) EXPECT_EQ(value, 0);
  const Eigen::Vector3d point(0.013, -0.021, 0.034);
  // as OpenCV does: a pinhole for plumb_bob, Kannala and Brandt for equidistant
  const double aside = point.head<2>().norm(), tangent = aside / point.z();
  const double distorted = GetParam() == LensKind::Rectilinear ? tangent : std::atan(tangent);
  const Eigen::Vector2d normalised = point.head<2>() / aside * distorted;
  const Eigen::Vector2d pixel(numbers.k[0] * normalised.x() + numbers.k[2],
                              numbers.k[4] * normalised.y() + numbers.k[5]);
  EXPECT_LT((pixel - pixelOf(round, point)).norm(), 1e-9);
  EXPECT_EQ(numbers.distortion_model, GetParam() == LensKind::Rectilinear ? "plumb_bob" : "equidistant");
  EXPECT_EQ(numbers.d.size(), GetParam() == LensKind::Rectilinear ? 5u : 4u);
}

TEST(Lens, EquidistantEnlargesTheMiddleAndRectilinearTheRim) {
  EXPECT_NEAR(focalLength(camera(LensKind::Equidistant)), 240 / (70 * kDegree), 1e-9);
  EXPECT_NEAR(focalLength(camera(LensKind::Rectilinear)), 240 / std::tan(70 * kDegree), 1e-9);
  // half of the field of view is half of the circle with the one, about a quarter with the other
  EXPECT_NEAR(radiusAt(camera(LensKind::Equidistant), 35 * kDegree), 120, 1e-9);
  EXPECT_NEAR(radiusAt(camera(LensKind::Rectilinear), 35 * kDegree),
              240 * std::tan(35 * kDegree) / std::tan(70 * kDegree), 1e-9);
}

TEST(Lens, RightCameraOfAPairSeesPointsDisplacedByFocalLengthTimesBaselineOverDepth) {
  const RoundCamera round = camera(LensKind::Rectilinear, 100);
  const double baseline = 0.004;
  const CameraNumbers right = numbersOf(round, baseline);
  const Eigen::Vector3d point(0.01, 0.005, 0.06);
  // P of the right camera is applied to points in the frame of the left one
  const double x = (right.p[0] * point.x() + right.p[2] * point.z() + right.p[3]) / point.z();
  EXPECT_NEAR(x, pixelOf(round, point - Eigen::Vector3d(baseline, 0, 0)).x(), 1e-9);
  EXPECT_NEAR(pixelOf(round, point).x() - x, focalLength(round) * baseline / point.z(), 1e-9);
  EXPECT_EQ(numbersOf(round, 0).p[3], 0);
}

TEST(Lens, PointBehindTheCameraHasNoPixelIfRectilinearAndADistantOneIfEquidistant) {
  EXPECT_TRUE(std::isnan(pixelOf(camera(LensKind::Rectilinear), {0.01, 0, -0.01}).x()));
  const Eigen::Vector2d pixel = pixelOf(camera(LensKind::Equidistant), {0.01, 0, -0.01});
  EXPECT_NEAR((pixel - camera(LensKind::Equidistant).middle()).norm(), 240 * 135 / 70., 1e-9);
  EXPECT_TRUE(std::isnan(pixelOf(camera(LensKind::Equidistant), {0, 0, 0}).x()));
}

TEST_P(BothLenses, SourceHasTheSharpnessOfTheCentreAndContainsTheCircle) {
  const RoundCamera round = camera(GetParam());
  for (const double sharpness : {0.5, 1., 2.}) {
    const SquareSource source = sourceFor(round, sharpness, 16384);
    EXPECT_GT(source.half_width, std::tan(70 * kDegree));
    EXPECT_LT(source.half_width, 1.02 * std::tan(70 * kDegree));
    const double pixels_per_tangent = 0.5 * source.size / source.half_width;
    EXPECT_GE(pixels_per_tangent, (1 - 1e-9) * sharpness * focalLength(round));
    EXPECT_LT(pixels_per_tangent, 1.01 * sharpness * focalLength(round));
  }
  EXPECT_EQ(sourceFor(round, 100, 2048).size, 2048);
}

TEST(Lens, LimitsOfFieldOfViewAndSizeAreInside) {
  for (const double radians : {kMinFieldOfView, kMaxFieldOfView})
    EXPECT_EQ(problemOf({LensKind::Rectilinear, radians, 640, 480}), "");
  for (const int size : {16, 4096}) EXPECT_EQ(problemOf(camera(LensKind::Equidistant, 140, size, size)), "");
}

TEST(Lens, ProblemNamesTheQuantityAndItsRange) {
  const std::string angle = "the field of view must be 10 to 170 degrees";
  const std::string size = "width and height must be 16 to 4096 pixels";
  for (const double degrees : {-140., 0., 9.99, 170.01, std::nan(""), HUGE_VAL})
    EXPECT_EQ(problemOf(camera(LensKind::Equidistant, degrees)), angle) << degrees;
  for (const int edge : {-640, 0, 15, 4097}) {
    EXPECT_EQ(problemOf(camera(LensKind::Rectilinear, 140, edge, 480)), size) << edge;
    EXPECT_EQ(problemOf(camera(LensKind::Rectilinear, 140, 640, edge)), size) << edge;
  }
}

/// Pixels of a source per pixel of the image at this angle: around the axis, and along the radius.
Eigen::Vector2d densityAt(const RoundCamera& camera, const SquareSource& source, double angle) {
  const double pixels = 0.5 * source.size / source.half_width, tangent = std::tan(angle);
  return {pixels * tangent / radiusAt(camera, angle), pixels * (1 + tangent * tangent) / focalLength(camera)};
}

TEST(LensSources, OfAWideLensHaveEnoughPixelsEverywhereAndFewerThanOne) {
  const RoundCamera camera;
  const LensSources two = sourcesFor(camera, 1, 4096);
  const double begin = std::atan(0.85 * two.middle.half_width);  // of the whole, in media/endoscope.frag
  for (double angle = 0.01; angle < 0.5 * camera.field_of_view; angle += 0.01) {
    const Eigen::Vector2d density = densityAt(camera, angle < begin ? two.middle : two.whole, angle);
    EXPECT_GE(density[0], angle < begin ? 1 : 0.72) << angle;
    EXPECT_GE(density[1], 1) << angle;
  }
  EXPECT_LT(densityAt(camera, two.whole, 0.1).maxCoeff(), 0.65);  // it alone would not do
  const SquareSource one = sourceFor(camera, 1, 4096);
  EXPECT_LT(two.whole.size * two.whole.size + two.middle.size * two.middle.size, 0.55 * one.size * one.size);
}

TEST(LensSources, OfOtherLensesAreOnePlane) {
  RoundCamera narrow, straight;
  narrow.field_of_view = 1.6, straight.lens = LensKind::Rectilinear;
  for (const RoundCamera& camera : {narrow, straight}) {
    const LensSources sources = sourcesFor(camera, 1, 4096);
    EXPECT_EQ(sources.middle.size, 0);
    EXPECT_EQ(sources.whole.size, sourceFor(camera, 1, 4096).size);
  }
  EXPECT_GT(sourcesFor(RoundCamera(), 1, 4096).middle.size, 0);
}

}  // namespace
}  // namespace vibe::graphics::lens_test
