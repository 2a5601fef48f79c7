#include "vibe_graphics/geometry/blood_shapes.hpp"

#include <gtest/gtest.h>

#include "shape_measures.hpp"

namespace vibe::graphics::blood_shapes_test {
namespace {

using Eigen::Vector3d;

constexpr double kPi = 3.14159265358979323846;

Wound woundOf(bool brisk) {
  Wound wound;
  wound.place = {0.03, 0.01, -0.02};
  wound.inward = -Vector3d::UnitX();
  wound.brisk = brisk;
  wound.rate = brisk ? 2.5e-7 : 1e-8;
  wound.amount = 1e-7;
  wound.age = 10;
  return wound;
}

ColouredShape shapeOf(const Wound& wound, const BloodStyle& style = {}) {
  SutureDrawing scene;
  scene.wounds = {wound};
  ColouredShape shape;
  appendBlood(scene, style, nullptr, shape);
  EXPECT_TRUE(isSound(shape));
  return shape;
}

Puddle puddleOf(double volume) {
  Puddle puddle;
  puddle.centre = {0.02, 0.03, 0.04};
  puddle.up = Vector3d(1, 2, -1).normalized();
  puddle.creep = Vector3d::Zero();
  puddle.volume = volume;
  puddle.max_height = 2.5e-3;
  puddle.max_radius = 1;
  return puddle;
}

double extentAlong(const ColouredShape& shape, const Vector3d& direction) {
  double min = 1e9, max = -1e9;
  for (std::size_t v = 0; v < shape.vertices.size(); ++v) {
    min = std::min(min, placeOf(shape, v).dot(direction));
    max = std::max(max, placeOf(shape, v).dot(direction));
  }
  return max - min;
}

double meanRed(const ColouredShape& shape) {
  double sum = 0;
  for (const PackedColour colour : shape.colours) sum += colour & 0xff;
  return sum / static_cast<double>(shape.colours.size()) / 255;
}

double maxAlpha(const ColouredShape& shape) {
  PackedColour max = 0;
  for (const PackedColour colour : shape.colours) max = std::max(max, colour >> 24);
  return max / 255.0;
}

double farthestApart(const ColouredShape& a, const ColouredShape& b) {
  double max = 0;
  for (std::size_t v = 0; v < a.vertices.size(); ++v) max = std::max(max, (placeOf(a, v) - placeOf(b, v)).norm());
  return max;
}

/// Of the part over the plane: what a triangle's shadow on the plane covers times its height.
double volumeOver(const ColouredShape& shape, const Puddle& puddle) {
  double sum = 0;
  for (std::size_t t = 0; t < shape.triangles.size(); t += 3) {
    const Vector3d a = placeOf(shape, shape.triangles[t]) - puddle.centre;
    const Vector3d b = placeOf(shape, shape.triangles[t + 1]) - puddle.centre;
    const Vector3d c = placeOf(shape, shape.triangles[t + 2]) - puddle.centre;
    const double height = (a + b + c).dot(puddle.up) / 3;
    if (height > 0) sum += 0.5 * (b - a).cross(c - a).dot(puddle.up) * height;
  }
  return sum;
}

TEST(Puddle, VolumeIsTheAmountLost) {
  for (const double volume : {1e-9, 1e-8, 1e-7, 6e-7})
    for (const double creep : {0.0, 0.6, 1.0}) {
      Puddle puddle = puddleOf(volume);
      puddle.creep = creep * puddle.up.cross(Vector3d::UnitX()).normalized();
      ColouredShape shape;
      appendPuddle(puddle, shape);
      ASSERT_TRUE(isSound(shape));
      EXPECT_NEAR(volumeOver(shape, puddle) / volume, 1, 0.05) << volume << " " << creep;
    }
}

TEST(Puddle, RadiusHasAMaximum) {
  Puddle puddle = puddleOf(1e-4);
  puddle.max_radius = 0.01;
  EXPECT_EQ(puddleRadius(puddle), 0.01);
}

TEST(Puddle, SmallDropIsAHemisphere) {
  const Puddle puddle = puddleOf(1e-10);
  EXPECT_NEAR(puddleRadius(puddle), std::cbrt(1e-10 * 3 / (2 * kPi)), 0.05 * puddleRadius(puddle));
}

TEST(Puddle, CreepsDownwards) {
  Puddle puddle = puddleOf(1e-7);
  const Vector3d down = puddle.up.cross(Vector3d::UnitX()).normalized();
  puddle.creep = down;
  ColouredShape shape;
  appendPuddle(puddle, shape);
  double below = 0, above = 0;
  for (std::size_t v = 0; v < shape.vertices.size(); ++v) {
    const double at = (placeOf(shape, v) - puddle.centre).dot(down);
    below = std::max(below, at), above = std::max(above, -at);
  }
  EXPECT_GT(below, 1.5 * above);
}

TEST(Blood, MildBleedingGrowsWithTheAmountLost) {
  Wound wound = woundOf(false);
  double before = 0;
  for (const double amount : {1e-9, 1e-8, 1e-7, 5e-7}) {
    wound.amount = amount;
    const double width = extentAlong(shapeOf(wound), Vector3d::UnitY());
    EXPECT_GT(width, 1.2 * before);
    before = width;
  }
}

TEST(Blood, MildBleedingStaysAtTheWoundAndBriskBleedingHasAJet) {
  const double mild = extentAlong(shapeOf(woundOf(false)), Vector3d::UnitX());
  const double brisk = extentAlong(shapeOf(woundOf(true)), Vector3d::UnitX());
  EXPECT_LT(mild, 5e-3);
  EXPECT_GT(brisk, 20e-3);
}

TEST(Blood, BriskIsBrighter) {
  EXPECT_GT(meanRed(shapeOf(woundOf(true))), meanRed(shapeOf(woundOf(false))) + 0.15);
}

TEST(Blood, JetFallsInTheDirectionOfGravity) {
  Wound wound = woundOf(true);
  wound.inward = Vector3d::UnitY();
  for (const Vector3d& down : {Vector3d(-1, 0, 0), Vector3d(0, 0, -1)}) {
    BloodStyle style;
    style.down = down;
    const double duration = jetDuration(wound, 0.04, style);
    const auto line = jetLine(wound, duration, style);
    EXPECT_LT((line.front() - wound.place).norm(), 1e-12);
    EXPECT_NEAR((jetPath(wound, duration, style).back() - wound.place).dot(down), 0.04, 1e-9);
    double shift = 0;
    for (std::size_t k = 1; k < line.size(); ++k) shift = std::max(shift, (line[k] - line[k - 1]).norm());
    EXPECT_LT(shift, 0.01);  // one stream
  }
}

/// Blood leaves upwards from the floor, and comes down again.
TEST(Blood, FountainRisesToTheBallisticHeight) {
  Wound wound = woundOf(true);
  wound.inward = Vector3d::UnitX();
  BloodStyle style;
  style.down = -Vector3d::UnitX();
  for (double time = 0; time < 1; time += 0.07) {
    style.time = time;
    double max = 0;
    for (const Vector3d& point : jetLine(wound, jetDuration(wound, 0, style), style))
      max = std::max(max, (point - wound.place).x());
    EXPECT_GT(max, 2e-3);
    EXPECT_LT(max, 1.4 * 1.4 * 0.5 * 0.5 / (2 * 9.81));
  }
}

TEST(Blood, PulsesWithTheHeartAndOnlyWithTheTimeOfTheMessage) {
  const double beat = 60.0 / 72;
  double min = 1e9, max = 0, sum = 0;
  for (int k = 0; k < 100; ++k) {
    const double speed = jetSpeed(k * beat / 100);
    min = std::min(min, speed), max = std::max(max, speed), sum += speed / 100;
    EXPECT_NEAR(jetSpeed(k * beat / 100 + 7 * beat), speed, 1e-9);
  }
  EXPECT_GT(max, 1.5 * min);
  EXPECT_GT(min, 0);
  EXPECT_NEAR(sum, 0.5, 1e-3);
  BloodStyle now, later;
  later.time = 0.3;
  const ColouredShape first = shapeOf(woundOf(true), now);
  EXPECT_EQ(farthestApart(first, shapeOf(woundOf(true), now)), 0);
  EXPECT_GT(farthestApart(first, shapeOf(woundOf(true), later)), 2e-3);
}

/// A jet that pulses changes places, not triangles: nothing but vertices is sent again.
TEST(Blood, TrianglesAreConstantWhileThePulseChanges) {
  BloodStyle style;
  const ColouredShape first = shapeOf(woundOf(true), style);
  for (double time = 0; time < 1; time += 0.05) {
    style.time = time;
    EXPECT_EQ(shapeOf(woundOf(true), style).vertices.size(), first.vertices.size()) << "time " << time;
  }
}

TEST(Blood, StoppedBleedingIsBrownPaleAndConstant) {
  for (const bool brisk : {false, true}) {
    Wound wound = woundOf(brisk);
    const ColouredShape bleeding = shapeOf(wound);
    wound.rate = 0;
    const ColouredShape stopped = shapeOf(wound);
    EXPECT_LT(meanRed(stopped), meanRed(bleeding) - 0.05);
    EXPECT_LT(maxAlpha(stopped), maxAlpha(bleeding));
    wound.age = 1000;
    EXPECT_LT(maxAlpha(shapeOf(wound)), maxAlpha(stopped));
    BloodStyle later;
    later.time = 0.3;
    EXPECT_EQ(farthestApart(shapeOf(wound), shapeOf(wound, later)), 0);
  }
}

TEST(Blood, JetEndsAtTheWallBelow) {
  SutureDrawing scene;
  scene.wounds = {woundOf(true)};
  scene.sets.resize(1);
  scene.sets[0].bites.push_back({scene.wounds[0].place + Vector3d(-0.045, 0, 0), true, Vector3d::UnitX()});
  ColouredShape known;
  appendBlood(scene, {}, nullptr, known);
  const double depth = extentAlong(known, Vector3d::UnitX());
  EXPECT_NEAR(depth, 0.045, 0.006);
  EXPECT_GT(depth, extentAlong(shapeOf(woundOf(true)), Vector3d::UnitX()) + 0.005);
}

TEST(Blood, WithoutBleedingNothingIsDrawn) {
  Wound wound = woundOf(false);
  wound.rate = wound.amount = 0;
  EXPECT_TRUE(shapeOf(wound).vertices.empty());
}

TEST(Blood, UnknownWallsAndAnyDirectionOfGravityAreDrawn) {
  for (const bool brisk : {false, true})
    for (const Vector3d& inward : {Vector3d(0, 0, 0), Vector3d(-1, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 0, 1)}) {
      Wound wound = woundOf(brisk);
      wound.inward = inward;
      EXPECT_FALSE(shapeOf(wound).vertices.empty());
    }
}

}  // namespace
}  // namespace vibe::graphics::blood_shapes_test
