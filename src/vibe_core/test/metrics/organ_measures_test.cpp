#include "vibe_core/metrics/organ_measures.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <chrono>
#include <limits>

#include "metrics/organs.hpp"
#include "vibe_core/builder/model_builder.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_testing/allocation_count.hpp"
#include "vibe_testing/worlds.hpp"

namespace vibe::organ_measures_test {
namespace {

using test::icosphere;
using test::plainOrgan;
using test::Positions;
using test::revolve;

constexpr double kRadius = 0.03, kLength = 0.3;

Organ tube() {
  return revolve([](double) { return kRadius; }, kLength);
}

OrganMeasures measureMapped(const Organ& organ, const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& map) {
  const Positions p(organ, map);
  return OrganRuler(organ).measure(p.x, p.y, p.z);
}

/// Bends a tube below z = 0 around a circle in the plane x-z; lengths on its axis stay.
Eigen::Vector3d bend(const Eigen::Vector3d& p, double angle) {
  const double circle = kLength / angle, turn = -p.z() / circle, out = circle - p.x();
  return {circle - out * std::cos(turn), p.y(), -out * std::sin(turn)};
}

const Organ& stomach() {
  static const Organ organ = buildOrgan(Scene());
  return organ;
}

TEST(OrganMeasures, ofATube) {
  const OrganMeasures m = OrganRuler(tube()).measureRest();
  const double area = M_PI * kRadius * kRadius;
  EXPECT_NEAR(m.volume, area * kLength, 2e-3 * area * kLength);
  EXPECT_NEAR(*m.length, kLength, 1e-9);
  EXPECT_NEAR(*m.greater_curvature, kLength + 2 * kRadius, 0.02 * kLength);
  EXPECT_NEAR(*m.body_length, kLength, 0.05 * kLength);
  EXPECT_NEAR(*m.mean_area, area, 2e-3 * area);
  EXPECT_NEAR(*m.min_area, area, 2e-3 * area);
  EXPECT_NEAR(*m.tubularity, 1, 1e-6);
}

TEST(OrganMeasures, ofASphere) {
  Organ organ = plainOrgan(icosphere(0.05, 4), 2e-3);
  organ.landmarks.fundus = Eigen::Vector3d(0, 0, 0.05);
  organ.landmarks.pylorus = Eigen::Vector3d(0, 0, -0.05);
  const OrganMeasures m = OrganRuler(organ).measureRest();
  EXPECT_NEAR(m.volume, 4.0 / 3 * M_PI * 1.25e-4, 2e-6);
  EXPECT_NEAR(*m.length, 0.1, 1e-3);
  EXPECT_NEAR(*m.greater_curvature, 0.05 * M_PI, 0.02 * 0.05 * M_PI);
  EXPECT_NEAR(*m.mean_area, 2.0 / 3 * M_PI * 25e-4, 0.02 * M_PI * 25e-4);
  EXPECT_NEAR(*m.tubularity, 1 - std::sqrt(0.2), 0.02) << "1 - s^2 has the mean 2/3 and the variance 4/45";
}

TEST(OrganMeasures, ofAnEllipsoidAndACone) {
  const Organ ellipsoid = revolve(
      [](double s) { return kRadius * std::sqrt(std::max(0.0, 1 - std::pow(2 * s / kLength - 1, 2))); }, kLength, 200);
  const double area = M_PI * kRadius * kRadius;
  const OrganMeasures e = OrganRuler(ellipsoid).measureRest();
  EXPECT_NEAR(*e.mean_area, 2.0 / 3 * area, 0.02 * area);
  EXPECT_NEAR(*e.length, kLength, 1e-9);
  EXPECT_NEAR(*e.tubularity, 1 - std::sqrt(0.2), 0.02);
  const Organ cone = revolve([](double s) { return kRadius * s / kLength; }, kLength);
  const OrganMeasures c = OrganRuler(cone).measureRest();
  EXPECT_NEAR(*c.mean_area, area / 3, 0.02 * area);
  EXPECT_NEAR(*c.tubularity, 1 - std::sqrt(0.8), 0.04);
  EXPECT_LT(*c.min_area, 0.01 * area);
  EXPECT_NEAR(*c.greater_curvature, std::hypot(kLength, kRadius) + kRadius, 0.01);
}

TEST(OrganMeasures, areOfTheBodyOnly) {
  // the lower half of a cone: the areas go from a quarter to the whole, mean (1 - 1/8) * 2 / 3 of the base
  Organ cone = revolve([](double s) { return kRadius * s / kLength; }, kLength);
  for (std::size_t v = 0; v < cone.region.size(); ++v)
    if (cone.surface.vertices[v].z() > -kLength / 2) cone.region[v] = Region::Fundus;
  const double base = M_PI * kRadius * kRadius;
  const OrganMeasures m = OrganRuler(cone).measureRest();
  EXPECT_NEAR(*m.body_length, kLength / 2, 0.03 * kLength);
  EXPECT_NEAR(*m.mean_area, 7.0 / 12 * base, 0.03 * base);
  EXPECT_NEAR(*m.min_area, base / 4, 0.03 * base);
}

TEST(OrganMeasures, doNotDependOnPlaceAndGrowWithSize) {
  const Organ organ = tube();
  const OrganMeasures rest = OrganRuler(organ).measureRest();
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const OrganMeasures m = measureMapped(
      organ, [&](const Eigen::Vector3d& p) { return Eigen::Vector3d(2 * turn * p + Eigen::Vector3d(0.1, 0.2, 0.3)); });
  EXPECT_NEAR(m.volume, 8 * rest.volume, 1e-9 * rest.volume);
  EXPECT_NEAR(*m.length, 2 * *rest.length, 1e-9);
  EXPECT_NEAR(*m.greater_curvature, 2 * *rest.greater_curvature, 1e-9);
  EXPECT_NEAR(*m.mean_area, 4 * *rest.mean_area, 1e-7 * *rest.mean_area);
  EXPECT_NEAR(*m.tubularity, *rest.tubularity, 1e-7);
}

TEST(OrganMeasures, followABend) {
  // from half a turn on, a plane across one leg cuts the other leg too
  Organ organ = tube();
  for (std::size_t v = 0; v < organ.region.size(); ++v)
    if (std::abs(organ.surface.vertices[v].z() + kLength / 2) > 0.45 * kLength) organ.region[v] = Region::Fundus;
  const double area = M_PI * kRadius * kRadius;
  for (double angle : {M_PI / 2, M_PI, 1.5 * M_PI}) {
    const OrganMeasures m = measureMapped(organ, [&](const Eigen::Vector3d& p) { return bend(p, angle); });
    EXPECT_NEAR(*m.length, kLength, 0.03 * kLength) << angle;
    EXPECT_NEAR(*m.mean_area, area, 2e-3 * area) << angle;
    EXPECT_GT(*m.tubularity, 0.999) << angle;
    EXPECT_NEAR(m.volume, area * kLength, 0.01 * area * kLength);
  }
}

TEST(OrganMeasures, seeAWaist) {
  const Organ organ = tube();
  const OrganMeasures rest = OrganRuler(organ).measureRest();
  const OrganMeasures m = measureMapped(organ, [](const Eigen::Vector3d& p) {
    const double width = 1 - 0.5 * std::exp(-std::pow((p.z() + kLength / 2) / 0.03, 2));
    return Eigen::Vector3d(width * p.x(), width * p.y(), p.z());
  });
  EXPECT_NEAR(*reduction(rest.min_area, m.min_area), 0.75, 0.02);
  EXPECT_LT(*m.tubularity, 0.85);
  // 1 - w^2 = e^-u^2 - e^-2u^2 / 4 over u = z / 30 mm: 30 mm sqrt(pi) (1 - 1 / (4 sqrt 2)) of the length
  const double lost = 0.03 * std::sqrt(M_PI) * (1 - 0.25 / std::sqrt(2)) / kLength;
  EXPECT_NEAR(*reduction(rest.volume, m.volume), lost, 3e-3);
  EXPECT_NEAR(*reduction(rest.mean_area, m.mean_area), lost, 0.01);
}

TEST(OrganMeasures, takeTheAreaOfAFoldAway) {
  // the wall on one side pressed in, to half of the radius on the other side of the axis
  const Organ organ = tube();
  const OrganMeasures m = measureMapped(
      organ, [](const Eigen::Vector3d& p) { return Eigen::Vector3d(p.x() > 0 ? -0.5 * p.x() : p.x(), p.y(), p.z()); });
  EXPECT_NEAR(*m.mean_area, M_PI * kRadius * kRadius / 4, 0.02 * M_PI * kRadius * kRadius);
}

TEST(OrganMeasures, seeAShortening) {
  const Organ organ = tube();
  const OrganMeasures rest = OrganRuler(organ).measureRest();
  const OrganMeasures m =
      measureMapped(organ, [](const Eigen::Vector3d& p) { return Eigen::Vector3d(p.x(), p.y(), 0.7 * p.z()); });
  EXPECT_NEAR(*reduction(rest.length, m.length), 0.3, 1e-6);
  EXPECT_NEAR(*reduction(rest.mean_area, m.mean_area), 0, 1e-6);
  EXPECT_NEAR(*reduction(rest.volume, m.volume), 0.3, 1e-9);
}

TEST(OrganMeasures, haveNoValueWithoutAnAxisOrABody) {
  const OrganMeasures ball = OrganRuler(plainOrgan(icosphere(0.05, 3), 2e-3)).measureRest();
  EXPECT_GT(ball.volume, 0);
  EXPECT_FALSE(ball.length);
  EXPECT_FALSE(ball.mean_area);
  Organ antrum = tube();
  antrum.region.assign(antrum.region.size(), Region::Antrum);
  const OrganMeasures m = OrganRuler(antrum).measureRest();
  EXPECT_TRUE(m.length);
  EXPECT_FALSE(m.mean_area);
  EXPECT_FALSE(m.tubularity);
  EXPECT_FALSE(reduction(std::nullopt, 1.0));
  EXPECT_FALSE(reduction(0.0, 1.0));
  EXPECT_DOUBLE_EQ(*reduction(2.0, 3.0), -0.5);
}

TEST(OrganMeasures, refuseWhatIsNoOrgan) {
  const Organ organ = tube();
  OrganRuler ruler(organ);
  Positions p(organ, [](const Eigen::Vector3d& v) { return v; });
  p.y[7] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(ruler.measure(p.x, p.y, p.z), Error);
  p.y.pop_back();
  EXPECT_THROW(ruler.measure(p.x, p.y, p.z), Error);
  EXPECT_NEAR(*ruler.measureRest().length, kLength, 1e-9) << "and goes on";
  Organ open = tube();
  open.surface.triangles.pop_back();
  EXPECT_THROW(OrganRuler{open}, Error);
}

TEST(OrganMeasures, ofTheStomachAreThoseOfAStomach) {
  const OrganMeasures m = OrganRuler(stomach()).measureRest();
  EXPECT_NEAR(m.volume, Scene().geometry.volume, 1e-9);
  // sections of the body times its length are its volume, which is most of the stomach's
  const double body = *m.mean_area * *m.body_length;
  RecordProperty("length_mm", std::to_string(1e3 * *m.length));
  RecordProperty("greater_curvature_mm", std::to_string(1e3 * *m.greater_curvature));
  RecordProperty("body_length_mm", std::to_string(1e3 * *m.body_length));
  RecordProperty("mean_area_cm2", std::to_string(1e4 * *m.mean_area));
  RecordProperty("least_area_cm2", std::to_string(1e4 * *m.min_area));
  RecordProperty("tubularity", std::to_string(*m.tubularity));
  EXPECT_GT(body, 0.6 * m.volume);
  EXPECT_LT(body, 0.9 * m.volume);
  EXPECT_GT(*m.min_area, 0.4 * *m.mean_area) << "a section of the body is none of the antrum or the oesophagus";
  EXPECT_GT(*m.greater_curvature, 1.1 * *m.length);
}

TEST(OrganMeasures, leaveTheOesophagusOut) {
  const OrganMeasures rest = OrganRuler(stomach()).measureRest();
  for (const Eigen::Vector3d& shift : {Eigen::Vector3d(0, 0, 0.05), Eigen::Vector3d(0.12, 0, -0.06)}) {
    Positions p(stomach(), [](const Eigen::Vector3d& v) { return v; });
    for (std::size_t v = 0; v < p.x.size(); ++v) {
      if (stomach().end[v] != End::Oesophagus) continue;
      p.x[v] += shift.x();
      p.z[v] += shift.z();
    }
    const OrganMeasures m = OrganRuler(stomach()).measure(p.x, p.y, p.z);
    EXPECT_NE(m.volume, rest.volume);
    EXPECT_DOUBLE_EQ(*m.length, *rest.length);
    EXPECT_NEAR(*m.mean_area, *rest.mean_area, 5e-3 * *rest.mean_area) << shift.transpose();
  }
}

TEST(OrganMeasures, leaveSectionsThroughTwoPartsOut) {
  Organ organ = stomach();
  organ.region.assign(organ.region.size(), Region::Body);
  const OrganMeasures m = OrganRuler(organ).measureRest();
  EXPECT_GT(*m.min_area, 1e-4) << "a plane beside the incisura has no section of its own";
  EXPECT_LT(*m.min_area, 4e-4) << "the duodenum, and no other end";
}

TEST(OrganMeasures, doNotDependOnTheMesh) {
  const OrganMeasures a = OrganRuler(stomach()).measureRest();
  for (const int particles : {600, 1200, 1500, 2500}) {
    SCOPED_TRACE(particles);
    Scene coarse;
    coarse.geometry.particles = particles;
    const OrganMeasures b = OrganRuler(buildOrgan(coarse)).measureRest();
    EXPECT_NEAR(*b.length, *a.length, 0.02 * *a.length);
    EXPECT_NEAR(*b.greater_curvature, *a.greater_curvature, 0.02 * *a.greater_curvature);
    EXPECT_NEAR(*b.mean_area, *a.mean_area, 0.04 * *a.mean_area);
    EXPECT_NEAR(*b.tubularity, *a.tubularity, 0.05);
  }
}

TEST(OrganMeasures, costNoMemory) {
  if (!VIBE_COUNTS_ALLOCATIONS) GTEST_SKIP() << "nothing counts allocations here";
  OrganRuler ruler(stomach());
  const Positions p(stomach(), [](const Eigen::Vector3d& v) { return v; });
  const long before = test::allocations;
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < 20; ++i) ruler.measure(p.x, p.y, p.z);
  const std::chrono::duration<double, std::milli> each = (std::chrono::steady_clock::now() - start) / 20;
  EXPECT_EQ(test::allocations, before);
  RecordProperty("ms", std::to_string(each.count()));
}

}  // namespace
}  // namespace vibe::organ_measures_test
