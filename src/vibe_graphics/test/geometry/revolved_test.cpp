#include "vibe_graphics/geometry/solid_bodies.hpp"

#include <gtest/gtest.h>

#include "shape_measures.hpp"
#include "vibe_graphics/geometry/tube.hpp"

namespace vibe::graphics::revolved_test {
namespace {

using Eigen::Vector3d;

constexpr double kPi = 3.14159265358979323846;
constexpr double kRounding = 3e-8;  // [m]
const Vector3d kCentre(0.05, -0.1, 0.02);
const Vector3d kAxis = Vector3d(0.3, 0.4, -0.86).normalized();

double heightOf(const Vector3d& p) {
  return (p - kCentre).dot(kAxis);
}

double outOf(const Vector3d& p) {
  return ((p - kCentre) - heightOf(p) * kAxis).norm();
}

TEST(Revolved, ARingIsATorus) {
  ColouredShape shape;
  appendRing(kCentre, kAxis, 0.004, 0.001, packed(1, 1, 1), 48, shape);
  ASSERT_TRUE(isSound(shape));
  for (std::size_t v = 0; v < shape.vertices.size(); ++v) {
    const Vector3d p = placeOf(shape, v);
    EXPECT_NEAR(std::hypot(outOf(p) - 0.004, heightOf(p)), 0.001, kRounding);
    const Vector3d outside = p + 0.0005 * normalOf(shape, v);
    EXPECT_NEAR(std::hypot(outOf(outside) - 0.004, heightOf(outside)), 0.0015, 2 * kRounding);
  }
  const double octagon = 4 * std::sin(kPi / 4) * 1e-6;  // the body is drawn with eight sides
  EXPECT_NEAR(volumeOf(shape) / (2 * kPi * 0.004 * octagon), 1, 0.01);
}

TEST(Revolved, ACylinderHasItsVolume) {
  ColouredShape shape;
  appendRevolved({{0.005, 0}, {0.005, 0.002}, {-0.005, 0.002}, {-0.005, 0}}, kCentre, kAxis, packed(1, 1, 1), 64,
                 shape);
  EXPECT_NEAR(volumeOf(shape) / (kPi * 4e-6 * 0.01), 1, 0.002);
  ColouredShape inside_out;  // control: the profile from the other end
  appendRevolved({{-0.005, 0}, {-0.005, 0.002}, {0.005, 0.002}, {0.005, 0}}, kCentre, kAxis, packed(1, 1, 1), 64,
                 inside_out);
  EXPECT_LT(volumeOf(inside_out), 0);
}

TEST(Revolved, ABobbinHasRimsAndAWaist) {
  ColouredShape shape;
  appendBobbin(kCentre, kAxis, 0.006, 0.0013, packed(1, 1, 1), 24, shape);
  ASSERT_TRUE(isSound(shape));
  EXPECT_GT(volumeOf(shape), 0);
  double rim = 0, waist = 1, top = 0;
  for (std::size_t v = 0; v < shape.vertices.size(); ++v) {
    const Vector3d p = placeOf(shape, v);
    rim = std::max(rim, outOf(p)), top = std::max(top, std::abs(heightOf(p)));
    if (std::abs(heightOf(p)) < 0.0005) waist = std::min(waist, outOf(p));
  }
  EXPECT_NEAR(rim, 0.0013, kRounding);
  EXPECT_NEAR(top, 0.003, kRounding);
  EXPECT_LT(waist, 0.7 * rim);
}

TEST(Revolved, ProfileOfOnePointDrawsNothing) {
  ColouredShape shape;
  appendRevolved({{0, 0.1}}, kCentre, kAxis, packed(1, 1, 1), 8, shape);
  EXPECT_TRUE(shape.vertices.empty());
}

}  // namespace
}  // namespace vibe::graphics::revolved_test
