#include "vibe_core/thermal/argon_beam.hpp"

#include <gtest/gtest.h>
#include "vibe_testing/allocation_count.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/test_surfaces.hpp"
#include "procedure/marking_worlds.hpp"

namespace vibe::argon_beam_test {
namespace {

using Eigen::Vector3d;
using test::MarkingWorld;

double totalPower(const ArgonBeam& beam) {
  double sum = 0;
  for (const BeamShare& share : beam.shares()) sum += share.power;
  return sum;
}

/// Flat square in the plane x = at, seen from smaller x; corners of the grid moved irregularly, edges kept.
SurfaceMesh sheet(double at, int cells, double side, double irregular = 0) {
  SurfaceMesh mesh;
  for (int i = 0; i <= cells; ++i) {
    for (int k = 0; k <= cells; ++k) {
      const bool inner = i > 0 && k > 0 && i < cells && k < cells;
      const double shift = inner ? irregular * side / cells * std::sin(12.9898 * i + 78.233 * k) : 0;
      mesh.vertices.emplace_back(at, side * i / cells - side / 2 + shift, side * k / cells - side / 2 - shift);
    }
  }
  const auto n = [&](int i, int k) { return i * (cells + 1) + k; };
  for (int i = 0; i < cells; ++i) {
    for (int k = 0; k < cells; ++k) {
      mesh.triangles.push_back({n(i, k), n(i + 1, k), n(i + 1, k + 1)});
      mesh.triangles.push_back({n(i, k), n(i + 1, k + 1), n(i, k + 1)});
    }
  }
  return mesh;
}

TEST(ArgonBeam, GivesAwayExactlyItsPower) {
  MarkingWorld world(test::markingBall(4));
  world.parameters.efficiency = 0.7;
  for (const Vector3d& aim : test::aims(world.organ.surface)) {
    ASSERT_GE(world.fireAt(aim).triangle, 0);
    EXPECT_NEAR(totalPower(world.beam), 0.7 * 40, 1e-12);
    for (const BeamShare& share : world.beam.shares()) EXPECT_GT(share.power, 0);
  }
}

TEST(ArgonBeam, MeetsTheWallWhereItIs) {
  MarkingWorld world(sheet(0.02, 20, 0.08));
  world.parameters.probe_length = 0.016;
  const Vector3d tip(0, 0.003, -0.002);
  const BeamHit& hit = world.beam.fire(tip, Vector3d(5, 0, 0), world.wall(), 1e-3, world.parameters);
  ASSERT_GE(hit.triangle, 0);
  EXPECT_LT((hit.point - Vector3d(0.02, 0.003, -0.002)).norm(), 1e-12);
  EXPECT_NEAR(hit.gap, 0.02 - 0.001 - 0.016, 1e-12);
  EXPECT_NEAR(hit.radius, 0.004 + 0.003 * std::tan(0.05), 1e-12);
}

TEST(ArgonBeam, EndsAtItsReach) {
  MarkingWorld world(sheet(0, 20, 0.08));
  const double farthest = world.parameters.probe_length + world.parameters.reach + 1e-3;  // of the tip
  const auto hits = [&](double distance) {
    return world.beam.fire({-distance, 0.001, 0.002}, {1, 0, 0}, world.wall(), 1e-3, world.parameters).triangle >= 0;
  };
  EXPECT_TRUE(hits(farthest - 1e-6));
  EXPECT_FALSE(hits(farthest + 1e-6));
  EXPECT_TRUE(world.beam.shares().empty());
  EXPECT_TRUE(hits(0.0005)) << "the tip pressed onto the mucosa";
  EXPECT_TRUE(hits(-0.0005)) << "the tip pressed into the wall";
  EXPECT_FALSE(hits(-0.002)) << "the wall is behind the tip";
}

TEST(ArgonBeam, DoesNotGoThroughAWall) {
  const SurfaceMesh front = sheet(0.010, 20, 0.08), back = sheet(0.012, 20, 0.08);
  const auto front_count = static_cast<int>(front.vertices.size());
  MarkingWorld world(test::join(front, back, Vector3d::Zero()));
  world.beam.fire(Vector3d::Zero(), Vector3d::UnitX(), world.wall(), 1e-3, world.parameters);
  ASSERT_FALSE(world.beam.shares().empty());
  for (const BeamShare& share : world.beam.shares()) EXPECT_LT(share.particle, front_count);
  // the order in which the sheets are stored does not matter, and without the front one the back one is hit
  for (double& value : world.x) value = 0.022 - value;
  world.beam.fire(Vector3d::Zero(), Vector3d::UnitX(), world.wall(), 1e-3, world.parameters);
  for (const BeamShare& share : world.beam.shares()) EXPECT_GE(share.particle, front_count);
  for (int i = front_count; i < 2 * front_count; ++i) world.x[i] = 1;
  world.beam.fire(Vector3d::Zero(), Vector3d::UnitX(), world.wall(), 1e-3, world.parameters);
  ASSERT_FALSE(world.beam.shares().empty());
  for (const BeamShare& share : world.beam.shares()) EXPECT_LT(share.particle, front_count);
}

TEST(ArgonBeam, SparesTheOtherSideOfAFold) {
  // one sheet folded about the z axis into two leaves 1 mm apart; both are within the radius of the spot
  MarkingWorld world(sheet(0, 40, 0.08));
  for (std::size_t i = 0; i < world.y.size(); ++i) {
    const double along = world.y[i];
    world.y[i] = -std::abs(along);
    world.x[i] = 0.010 + 0.0005 * std::tanh(along / 5e-4);
  }
  world.beam.fire({0, -0.003, 0.0003}, Vector3d::UnitX(), world.wall(), 1e-4, world.parameters);
  ASSERT_GT(world.beam.shares().size(), 5u);
  for (const BeamShare& share : world.beam.shares())
    EXPECT_LT(world.organ.surface.vertices[share.particle].y(), 0.0025) << "behind the fold";
}

TEST(ArgonBeam, PowerPerAreaIsThatOfTheFootprint) {
  // irregular sheets of finer and finer grids against the formula on the continuous plane
  const double radius = 0.004, whole = M_PI * radius * radius * std::sqrt(M_PI / 2);  // integral of the footprint
  double last = 1;
  for (const int cells : {20, 40, 80}) {
    MarkingWorld world(sheet(0.005, cells, 0.08, 0.15));
    world.beam.fire({0, 0.0007, 0.0011}, Vector3d::UnitX(), world.wall(), 1e-4, world.parameters);
    const auto areas = vertexAreas(world.organ.surface);
    double worst = 0;
    for (const BeamShare& share : world.beam.shares()) {
      const double d = (world.organ.surface.vertices[share.particle] - world.beam.hit().point).norm();
      const double expected = 40 / whole * std::exp(-0.5 * std::pow(d / radius, 4));
      worst = std::max(worst, std::abs(share.power / areas[share.particle] - expected) * whole / 40);
      EXPECT_NEAR(share.spot_power, 40 * std::exp(-0.5 * std::pow(d / radius, 4)), 1e-9);
    }
    EXPECT_LT(worst, last) << cells;
    last = std::max(0.01, 0.7 * worst);
  }
  EXPECT_LT(last, 0.011);
}

TEST(ArgonBeam, WidensAndWeakensWithTheGap) {
  MarkingWorld near(test::markingBall(5)), far(test::markingBall(5));
  const Vector3d aim = near.organ.surface.vertices[700];
  far.parameters.spread = near.parameters.spread = 0.2;
  near.fireAt(aim, 0);
  far.fireAt(aim, 0.0045);
  const double radius = 0.004 + 0.0045 * std::tan(0.2);
  EXPECT_NEAR(far.beam.hit().radius, radius, 1e-12);
  EXPECT_NEAR(near.beam.shares().front().spot_power, 40, 1e-9);
  EXPECT_NEAR(far.beam.shares().front().spot_power, 40 * std::pow(0.004 / radius, 2), 1e-9);
  EXPECT_NEAR(totalPower(far.beam), 40, 1e-12) << "not less power, but over more of the wall";
}

TEST(ArgonBeam, FiresWhereverTheScopeIs) {
  // the same wall turned and moved: the same shares
  MarkingWorld world(test::markingBall(4)), turned(test::markingBall(4));
  const Eigen::Isometry3d pose =
      Eigen::Translation3d(0.3, -0.1, 0.2) * Eigen::AngleAxisd(1.1, Vector3d(1, 2, -1).normalized());
  for (std::size_t i = 0; i < turned.x.size(); ++i) {
    const Vector3d p = pose * world.organ.surface.vertices[i];
    turned.x[i] = p.x(), turned.y[i] = p.y(), turned.z[i] = p.z();
  }
  const Vector3d tip(0.045, 0.003, 0.001), direction(1, 0.1, -0.05);
  world.beam.fire(tip, direction, world.wall(), 1e-3, world.parameters);
  turned.beam.fire(pose * tip, pose.linear() * direction, turned.wall(), 1e-3, world.parameters);
  ASSERT_FALSE(world.beam.shares().empty());
  ASSERT_EQ(world.beam.shares().size(), turned.beam.shares().size());
  for (std::size_t i = 0; i < world.beam.shares().size(); ++i) {
    EXPECT_EQ(world.beam.shares()[i].particle, turned.beam.shares()[i].particle);
    EXPECT_NEAR(world.beam.shares()[i].power, turned.beam.shares()[i].power, 1e-9);
  }
}

TEST(ArgonBeam, HeatsTheStretchedWallByItsAreaNow) {
  // the wall stretched twofold: half of the particles under the same footprint, the same power
  MarkingWorld world(sheet(0.005, 80, 0.08));
  const auto count = [&] {
    world.beam.fire({0, 0.0003, 0.0002}, Vector3d::UnitX(), world.wall(), 1e-4, world.parameters);
    return world.beam.shares().size();
  };
  const std::size_t before = count();
  for (double& value : world.y) value *= 2;
  EXPECT_NEAR(static_cast<double>(count()), 0.5 * static_cast<double>(before), 0.1 * static_cast<double>(before));
  EXPECT_NEAR(totalPower(world.beam), 40, 1e-12);
}

TEST(ArgonBeam, MeetsNothingWithoutANumber) {
  MarkingWorld world(sheet(0.010, 20, 0.08));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto fire = [&](const Vector3d& tip, const Vector3d& direction) {
    return world.beam.fire(tip, direction, world.wall(), 1e-3, world.parameters).triangle;
  };
  ASSERT_GE(fire(Vector3d::Zero(), Vector3d::UnitX()), 0);
  EXPECT_EQ(fire({nan, 0, 0}, Vector3d::UnitX()), -1);
  EXPECT_EQ(fire(Vector3d::Zero(), {0, nan, 0}), -1);
  EXPECT_EQ(fire(Vector3d::Zero(), Vector3d::Zero()), -1);
  EXPECT_TRUE(world.beam.shares().empty());
  std::fill(world.y.begin(), world.y.end(), nan);
  EXPECT_EQ(fire(Vector3d::Zero(), Vector3d::UnitX()), -1);
}

TEST(ArgonBeam, CarriesTheSpotOnACoarseMesh) {
  // 162 particles, 15 mm apart: no particle need be within the footprint, and yet the power goes somewhere
  MarkingWorld world(test::icosphere(0.058, 2));
  for (const Vector3d& aim : test::aims(world.organ.surface)) {
    ASSERT_GE(world.fireAt(aim).triangle, 0);
    EXPECT_NEAR(totalPower(world.beam), 40, 1e-12);
    EXPECT_GT(world.beam.shares().front().spot_power, 0.4 * 40);
  }
}

TEST(ArgonBeam, DoesNotAllocateAfterItsFirstUse) {
  if (!VIBE_COUNTS_ALLOCATIONS) GTEST_SKIP() << "a sanitizer brings its own memory";
  MarkingWorld world(test::markingBall(4));
  const auto points = test::aims(world.organ.surface);
  world.fireAt(points[0]);
  const long before = test::allocations;
  for (const Vector3d& aim : points) world.fireAt(aim);
  EXPECT_EQ(test::allocations, before);
}

}  // namespace
}  // namespace vibe::argon_beam_test
