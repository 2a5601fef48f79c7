#include "vibe_core/thermal/mark_zones.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/regions.hpp"
#include "procedure/marking_worlds.hpp"
#include "vibe_core/builder/model_builder.hpp"
#include "vibe_core/geometry/triangle_tree.hpp"

namespace vibe::mark_zones_test {
namespace {

using Eigen::Vector3d;
using test::MarkingWorld;

/// A ball that is labelled as a stomach with its axis along z: body in the middle, quarters as walls.
MarkingWorld labelledBall() {
  MarkingWorld world(test::markingBall(4));
  for (std::size_t p = 0; p < world.x.size(); ++p) {
    const Vector3d& at = world.organ.surface.vertices[p];
    const double angle = std::atan2(at.y(), at.x());
    world.organ.wall[p] = std::abs(angle) < M_PI / 4        ? Wall::Anterior
                          : std::abs(angle) >= 3 * M_PI / 4 ? Wall::Posterior
                          : angle > 0                       ? Wall::GreaterCurvature
                                                            : Wall::LesserCurvature;
    world.organ.region[p] = at.z() > 0.035 ? Region::Fundus : at.z() < -0.035 ? Region::Antrum : Region::Body;
  }
  return world;
}

/// A line along the axis at an angle around it, from z = from to z = to, at 5 mm/s.
void drawLine(MarkingWorld& world, double angle, double from, double to) {
  const double seconds = std::abs(to - from) / 0.005;
  world.mark(seconds, 1.0 / 60, [&](double time) {
    const double z = from + (to - from) * time / seconds, r = std::sqrt(0.058 * 0.058 - z * z);
    return Vector3d(r * std::cos(angle), r * std::sin(angle), z);
  });
}

TEST(MarkZones, TellTheThreeLinesOfASuccessfulMarking) {
  MarkingWorld world = labelledBall();
  for (const double angle : {0.0, M_PI / 2, M_PI}) drawLine(world, angle, -0.02, 0.02);
  const ThermalDose law(world.parameters);
  MarkFinder finder(world.organ);
  const auto& zones = finder.find(law, world.dose, world.wall());
  ASSERT_EQ(zones.size(), 3u);
  int found[kWallCount] = {};
  for (const MarkZone& zone : zones) {
    ++found[static_cast<int>(zone.wall)];
    EXPECT_EQ(zone.region, Region::Body);
    EXPECT_EQ(zone.grade, BurnGrade::Mark);
    EXPECT_TRUE(zone.in_zone);
    EXPECT_GT(zone.count, 10);
    EXPECT_LT(std::abs(zone.centre.z()), 0.003);
  }
  EXPECT_EQ(found[0], 1);
  EXPECT_EQ(found[1], 1);
  EXPECT_EQ(found[2], 1);
  for (const Wall wall : {Wall::Anterior, Wall::GreaterCurvature, Wall::Posterior})
    EXPECT_NEAR(finder.walls()[static_cast<int>(wall)].length, 0.045, 0.008);
  EXPECT_EQ(finder.walls()[static_cast<int>(Wall::LesserCurvature)].count, 0);
}

Organ stomach(int particles) {
  Scene scene;
  scene.geometry.particles = particles;
  return buildOrgan(scene);
}

/// Points on the wall and directions towards them.
struct Line {
  std::vector<Vector3d> points, out;
  double length = 0;

  /// Along the axis of a stomach, in its body, at an angle around it.
  Line(const Organ& organ, const StomachAxis& axis, double angle) {
    const TriangleTree tree(organ.surface);
    for (const auto& station : axis.stations()) {
      if (station.length < 0.105 || station.length > 0.185) continue;
      out.push_back(std::cos(angle) * station.anterior + std::sin(angle) * station.greater);
      points.push_back(station.centre + tree.firstHit(station.centre, out.back()) * out.back());
      if (points.size() > 1) length += (points.back() - points[points.size() - 2]).norm();
    }
  }

  /// At a length of the line, with the tip 14 mm off the wall; the probe is 10 mm long.
  void fire(MarkingWorld& world, double rest) const {
    std::size_t i = 0;
    for (double side; i + 2 < points.size() && rest > (side = (points[i + 1] - points[i]).norm()); ++i) rest -= side;
    const double part = rest / (points[i + 1] - points[i]).norm();
    const Vector3d way = ((1 - part) * out[i] + part * out[i + 1]).normalized();
    const Vector3d tip = (1 - part) * points[i] + part * points[i + 1] - 0.014 * way;
    EXPECT_GE(world.beam.fire(tip, way, world.wall(), MarkingWorld::kHalfWall, world.parameters).triangle, 0);
  }
};

/// Anterior wall, greater curvature and posterior wall, as in figure 4a of Erden et al.
std::vector<Line> threeLines(const Organ& organ) {
  const StomachAxis axis = findAxis(organ);
  return {Line(organ, axis, 0), Line(organ, axis, M_PI / 2), Line(organ, axis, M_PI)};
}

TEST(MarkZones, AreTheSameInStomachsOfThreeAndFifteenThousandParticles) {
  double area[2][kWallCount] = {}, length[2][kWallCount] = {};
  const std::vector<Line> lines = threeLines(stomach(3618));
  for (const int fine : {0, 1}) {
    Organ organ = stomach(fine == 0 ? 3618 : 15000);
    MarkingWorld world(organ.surface);
    world.organ = std::move(organ);
    for (const Line& line : lines)
      world.expose(line.length / 0.005, 1.0 / 60, [&](double time) { line.fire(world, 0.005 * time); });
    MarkFinder finder(world.organ);
    const auto& zones = finder.find(ThermalDose(world.parameters), world.dose, world.wall());
    ASSERT_EQ(zones.size(), 3u);
    for (const MarkZone& zone : zones) {
      EXPECT_TRUE(zone.in_zone);
      EXPECT_EQ(zone.grade, BurnGrade::Mark);
      area[fine][static_cast<int>(zone.wall)] += zone.area;
      length[fine][static_cast<int>(zone.wall)] = finder.walls()[static_cast<int>(zone.wall)].length;
    }
  }
  for (const Wall wall : {Wall::Anterior, Wall::GreaterCurvature, Wall::Posterior}) {
    const int w = static_cast<int>(wall);
    EXPECT_NEAR(area[0][w] / area[1][w], 1, 0.15) << toString(wall);
    EXPECT_NEAR(length[0][w] / length[1][w], 1, 0.1) << toString(wall);
    EXPECT_GT(length[0][w], 0.04);
  }
}

TEST(MarkZones, SeeWhatIsOutside) {
  MarkingWorld world = labelledBall();
  world.hold({0, -0.058, 0}, 2);               // lesser curvature
  world.hold({0.03, 0, 0.05}, 2);              // fundus
  world.hold(Vector3d(0.0462, 0, -0.035), 2);  // on the border of the antrum
  world.hold(Vector3d(0, 0.058, 0), 2);        // as wanted
  const ThermalDose law(world.parameters);
  MarkFinder finder(world.organ);
  int inside = 0, outside = 0;
  for (const MarkZone& zone : finder.find(law, world.dose, world.wall())) ++(zone.in_zone ? inside : outside);
  EXPECT_EQ(inside, 1);
  EXPECT_EQ(outside, 3);
}

TEST(MarkZones, TellABurnByItsWorstParticle) {
  MarkingWorld world = labelledBall();
  drawLine(world, M_PI / 2, -0.02, 0.02);
  const Vector3d scar(0, 0.058, 0.01);
  world.hold(scar, 18);
  const ThermalDose law(world.parameters);
  MarkFinder finder(world.organ);
  const auto& zones = finder.find(law, world.dose, world.wall());
  ASSERT_EQ(zones.size(), 1u);
  EXPECT_EQ(zones.front().grade, BurnGrade::Burn);
  EXPECT_LT((world.wall().position(zones.front().particle) - scar.normalized() * 0.058).norm(), 0.004);
}

TEST(MarkZones, FindNothingWhereNothingIs) {
  MarkingWorld world = labelledBall();
  MarkFinder finder(world.organ);
  const ThermalDose law(world.parameters);
  EXPECT_TRUE(finder.find(law, world.dose, world.wall()).empty());
  world.hold({0, 0.058, 0}, 0.2);
  EXPECT_GT(world.maxDose(), 0);
  EXPECT_TRUE(finder.find(law, world.dose, world.wall()).empty()) << "warm, not marked";
  world.hold({0, 0.058, 0}, 2);
  for (int again = 0; again < 2; ++again) EXPECT_EQ(finder.find(law, world.dose, world.wall()).size(), 1u);
  std::fill(world.dose.begin(), world.dose.end(), 0);
  EXPECT_TRUE(finder.find(law, world.dose, world.wall()).empty()) << "nothing is kept from the last call";
  for (const WallMarks& wall : finder.walls()) EXPECT_EQ(wall.count, 0);
}

TEST(MarkZones, AreaIsThatOfTheMarkedParticles) {
  MarkingWorld world = labelledBall();
  world.dose.assign(world.dose.size(), 100);
  MarkFinder finder(world.organ);
  const auto& zones = finder.find(ThermalDose(world.parameters), world.dose, world.wall());
  ASSERT_EQ(zones.size(), 1u);
  EXPECT_NEAR(zones.front().area, surfaceArea(world.organ.surface), 1e-9);
  EXPECT_LT(zones.front().centre.norm(), 1e-9);
  EXPECT_FALSE(zones.front().in_zone);
}

}  // namespace
}  // namespace vibe::mark_zones_test
