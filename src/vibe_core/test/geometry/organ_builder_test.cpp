#include "vibe_core/builder/model_builder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>

#include "geometry/mesh_quality.hpp"
#include "geometry/regions.hpp"
#include "geometry/surface_check.hpp"
#include "geometry/surface_operators.hpp"
#include "vibe_core/geometry/triangle_tree.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::organ_builder_test {
namespace {

const Organ& defaultStomach() {
  static const Organ organ = buildOrgan(Scene{});
  return organ;
}

Scene sphereScene(int particles) {
  Scene scene;
  scene.geometry.kind = GeometryScene::Kind::Sphere;
  scene.geometry.particles = particles;
  return scene;
}

bool sameBits(const Organ& a, const Organ& b) {
  return a.surface.triangles == b.surface.triangles && a.region == b.region && a.wall == b.wall && a.end == b.end &&
         a.thickness == b.thickness &&
         std::equal(a.surface.vertices.begin(), a.surface.vertices.end(), b.surface.vertices.begin(),
                    b.surface.vertices.end(), [](const auto& p, const auto& q) { return p == q; });
}

/// Length of the line of the outermost wall on the greater curvature, from the fundus to a length along the axis.
double outerLength(const Organ& organ, const StomachAxis& axis, double end) {
  const TriangleTree tree(organ.surface);
  double length = 0;
  Eigen::Vector3d last = organ.landmarks.fundus;
  for (const auto& station : axis.stations()) {
    if (station.length > end) break;
    const Eigen::Vector3d p = station.centre + tree.firstHit(station.centre, station.greater) * station.greater;
    length += (p - last).norm();
    last = p;
  }
  return length;
}

/// Way over the fundus from the piece of oesophagus to the apex.
double domeLength(const Organ& organ) {
  int apex = 0;
  std::vector<int> gullet;
  for (int v = 0; v < static_cast<int>(organ.surface.vertices.size()); ++v) {
    const Eigen::Vector3d& p = organ.surface.vertices[v];
    if ((p - organ.landmarks.fundus).norm() < (organ.surface.vertices[apex] - organ.landmarks.fundus).norm()) apex = v;
    const Eigen::Vector3d from = p - organ.entry;
    if (from.cross(organ.entry_axis).norm() < 0.014 && from.dot(organ.entry_axis) < 0.02) gullet.push_back(v);
  }
  return edgeDistances(organ.surface, gullet)[apex];
}

TEST(Stomach, hasExactlyTheParticlesAndTheVolume) {
  const Organ& organ = defaultStomach();
  const std::size_t count = 3618;
  EXPECT_EQ(organ.surface.vertices.size(), count);
  EXPECT_EQ(organ.region.size(), count);
  EXPECT_EQ(organ.wall.size(), count);
  EXPECT_EQ(organ.end.size(), count);
  EXPECT_EQ(organ.thickness.size(), count);
  EXPECT_NEAR(enclosedVolume(organ.surface), Scene{}.geometry.volume, 1e-12);
}

TEST(Stomach, isAnEvenClosedSurface) {
  const Organ& organ = defaultStomach();
  EXPECT_NO_THROW(checkSurface(organ.surface, "stomach"));
  const test::MeshQuality quality = test::measureQuality(organ.surface);
  EXPECT_LT(quality.edge_variation, 0.12);
  EXPECT_GT(quality.smallest_angle, 30 * M_PI / 180);
  EXPECT_GE(quality.smallest_valence, 5);
  EXPECT_LE(quality.largest_valence, 7);
}

TEST(Stomach, hasTheSizeOfAFedStomach) {
  // magnetic resonance imaging: length 184 to 226 mm, largest diameter 65 to 102 mm
  const Organ& organ = defaultStomach();
  double length = 0, front = 0, back = 0;
  for (const auto& a : organ.surface.vertices) {
    for (const auto& b : organ.surface.vertices) length = std::max(length, (a - b).norm());
    front = std::max(front, a.x());
    back = std::min(back, a.x());
  }
  EXPECT_GT(length, 0.184);
  EXPECT_LT(length, 0.226);
  EXPECT_GT(front - back, 0.065);
  EXPECT_LT(front - back, 0.102);
  const TriangleTree tree(organ.surface);  // the widest place of the body
  const double width = tree.firstHit({0, 0.03, 0.03}, Eigen::Vector3d::UnitY()) +
                       tree.firstHit({0, 0.03, 0.03}, -Eigen::Vector3d::UnitY());
  EXPECT_GT(width, 0.065);
  EXPECT_LT(width, 0.102);
}

TEST(Stomach, isAJ) {
  const Organ& organ = defaultStomach();
  const Landmarks& l = organ.landmarks;
  EXPECT_GT(l.fundus.z(), l.oesophagus.z() + 0.02);   // the dome rises above the junction
  EXPECT_GT(l.fundus.y(), l.oesophagus.y() + 0.02);   // to the left of it
  EXPECT_LT(l.pylorus.y(), l.oesophagus.y() - 0.03);  // the pylorus is on the right
  double lowest = 0;
  for (const auto& v : organ.surface.vertices) lowest = std::min(lowest, v.z());
  EXPECT_LT(lowest, l.pylorus.z() - 0.03);  // the antrum rises to it
  EXPECT_GT(l.incisura.z(), lowest + 0.03);
}

TEST(Stomach, greaterCurvatureIsMuchLongerThanTheLesser) {
  const Organ& organ = defaultStomach();
  const StomachAxis axis = findAxis(organ);
  const TriangleTree tree(organ.surface);
  const auto nearest = [&](const Eigen::Vector3d& p) { return organ.surface.triangles[tree.closest(p).triangle][0]; };
  const int pylorus = nearest(organ.landmarks.pylorus);
  const Eigen::Vector3d right =
      -Eigen::Vector3d::UnitY();  // the lesser curvature goes on from the right of the junction
  const Eigen::Vector3d& middle = organ.landmarks.oesophagus;
  const int junction = nearest(middle + tree.firstHit(middle, right) * right);
  // the greater curvature begins at the notch beside the oesophagus and goes over the dome, the lesser at the junction
  const double greater = domeLength(organ) + outerLength(organ, axis, axis.lengthAt(pylorus));
  const double lesser = edgeDistances(organ.surface, {junction})[pylorus];
  RecordProperty("greater_mm", std::to_string(greater * 1e3));
  RecordProperty("lesser_mm", std::to_string(lesser * 1e3));
  EXPECT_GT(greater / lesser, 3.0);
  EXPECT_LT(greater / lesser, 5.0);
}

TEST(Stomach, everyRegionAndWallHasParticles) {
  const Organ& organ = defaultStomach();
  for (int r = 0; r < kRegionCount; ++r) {
    EXPECT_GT(std::count(organ.region.begin(), organ.region.end(), static_cast<Region>(r)), 100)
        << toString(static_cast<Region>(r));
  }
  for (int w = 0; w < kWallCount; ++w) {
    EXPECT_GT(std::count(organ.wall.begin(), organ.wall.end(), static_cast<Wall>(w)), 500)
        << toString(static_cast<Wall>(w));
  }
}

TEST(Stomach, regionsFollowEachOtherAlongTheAxis) {
  const Organ& organ = defaultStomach();
  const StomachAxis axis = findAxis(organ);
  std::array<double, kRegionCount> min, max;
  min.fill(1e9);
  max.fill(-1e9);
  for (int v = 0; v < static_cast<int>(organ.region.size()); ++v) {
    const int r = static_cast<int>(organ.region[v]);
    min[r] = std::min(min[r], axis.lengthAt(v));
    max[r] = std::max(max[r], axis.lengthAt(v));
  }
  const auto at = [](Region r) { return static_cast<int>(r); };
  EXPECT_LE(max[at(Region::Body)], min[at(Region::Antrum)]);
  EXPECT_LE(max[at(Region::Antrum)], min[at(Region::Pylorus)]);
  EXPECT_LE(max[at(Region::Fundus)], min[at(Region::Antrum)]);
  EXPECT_LT(min[at(Region::Fundus)], min[at(Region::Body)]);
  EXPECT_LE(max[at(Region::Cardia)], min[at(Region::Antrum)]);
}

TEST(Stomach, wallsFaceWhereTheirNamesSay) {
  const Organ& organ = defaultStomach();
  const auto normals = vertexNormals(organ.surface);
  std::array<Eigen::Vector3d, kWallCount> mean;
  mean.fill(Eigen::Vector3d::Zero());
  for (std::size_t v = 0; v < normals.size(); ++v) {
    if (organ.region[v] == Region::Body) mean[static_cast<int>(organ.wall[v])] += normals[v];
  }
  const auto of = [&](Wall w) { return mean[static_cast<int>(w)].normalized(); };
  EXPECT_GT(of(Wall::Anterior).x(), 0.8);
  EXPECT_LT(of(Wall::Posterior).x(), -0.8);
  EXPECT_GT(of(Wall::GreaterCurvature).y(), 0.7);
  EXPECT_LT(of(Wall::LesserCurvature).y(), -0.7);
}

TEST(Stomach, endsAreDomesAtTheTubes) {
  const Organ& organ = defaultStomach();
  int gullet = 0, duodenum = 0;
  for (std::size_t v = 0; v < organ.end.size(); ++v) {
    const Eigen::Vector3d& x = organ.surface.vertices[v];
    if (organ.end[v] == End::Oesophagus) {
      ++gullet;
      EXPECT_LT((x - organ.entry).norm(), 0.015);
      EXPECT_EQ(organ.region[v], Region::Cardia);
    }
    if (organ.end[v] == End::Duodenum) {
      ++duodenum;
      EXPECT_LT((x - organ.landmarks.pylorus).norm(), 0.04);
      EXPECT_EQ(organ.region[v], Region::Pylorus);
    }
  }
  EXPECT_GE(gullet, 10);
  EXPECT_GE(duodenum, 10);
}

class StomachVolume : public testing::TestWithParam<double> {};

TEST_P(StomachVolume, letsAStraightScopeIn) {
  Scene scene;
  scene.geometry.volume = GetParam();
  const Organ organ = buildOrgan(scene);
  const TriangleTree tree(organ.surface);
  const double length = 0.12 * std::min(1.0, std::cbrt(GetParam() / 0.75e-3));
  for (double s = 0; s <= length; s += 1e-3) {
    const Eigen::Vector3d p = organ.entry + s * organ.entry_axis;
    EXPECT_GT(tree.closest(p).distance, 6e-3 + 1.5e-3) << "at " << s * 1e3 << " mm";  // scope and half of the wall
  }
  EXPECT_GT(tree.closest(organ.entry + 0.8 * length * organ.entry_axis).distance, 0.015);  // well inside the body
  EXPECT_NEAR(organ.entry_axis.norm(), 1, 1e-12);
  EXPECT_NEAR(enclosedVolume(organ.surface), GetParam(), 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Litres, StomachVolume, testing::Values(0.3e-3, 0.75e-3, 1.3e-3));

TEST(Stomach, thicknessFollowsTheRegions) {
  const Organ& organ = defaultStomach();
  const TissueScene tissue;
  const auto areas = vertexAreas(organ.surface);
  double given = 0, smooth = 0;
  std::array<double, kRegionCount> sum{}, area{};
  for (std::size_t v = 0; v < areas.size(); ++v) {
    const int r = static_cast<int>(organ.region[v]);
    given += areas[v] * tissue.thickness[r];
    smooth += areas[v] * organ.thickness[v];
    sum[r] += areas[v] * organ.thickness[v];
    area[r] += areas[v];
    EXPECT_GT(organ.thickness[v], 1.96e-3);
    EXPECT_LT(organ.thickness[v], 2.71e-3);
  }
  EXPECT_NEAR(smooth, given, 1e-12);  // spreading over the borders keeps the amount of tissue
  for (int r = 0; r < kRegionCount; ++r) EXPECT_NEAR(sum[r] / area[r], tissue.thickness[r], 0.15e-3);
  for (const auto& t : organ.surface.triangles) {
    EXPECT_LT(std::abs(organ.thickness[t[0]] - organ.thickness[t[1]]), 0.12e-3);  // no jump
  }
}

TEST(Stomach, givesTheSameBitsTwice) {
  Scene scene;
  scene.geometry.particles = 1200;
  EXPECT_TRUE(sameBits(buildOrgan(scene), buildOrgan(scene)));
}

class StomachCount : public testing::TestWithParam<int> {};

TEST_P(StomachCount, isMetExactly) {
  Scene scene;
  scene.geometry.particles = GetParam();
  const Organ organ = buildOrgan(scene);
  EXPECT_EQ(static_cast<int>(organ.surface.vertices.size()), GetParam());
  EXPECT_NO_THROW(checkSurface(organ.surface, "stomach"));
  EXPECT_GT(std::count(organ.end.begin(), organ.end.end(), End::Oesophagus), 0);
  EXPECT_GT(std::count(organ.end.begin(), organ.end.end(), End::Duodenum), 0);
}

INSTANTIATE_TEST_SUITE_P(Numbers, StomachCount, testing::Values(100, 500, 1000, 15000));

TEST(Sphere, hasItsRadiusEverywhere) {
  for (const int particles : {100, 642, 3618}) {
    const Organ organ = buildOrgan(sphereScene(particles));
    EXPECT_EQ(static_cast<int>(organ.surface.vertices.size()), particles);
    for (const auto& v : organ.surface.vertices) EXPECT_NEAR(v.norm(), 0.05, 1e-12);
    EXPECT_NO_THROW(checkSurface(organ.surface, "sphere"));
    EXPECT_EQ(std::count(organ.end.begin(), organ.end.end(), End::None), particles);
    EXPECT_EQ(std::count(organ.region.begin(), organ.region.end(), Region::Body), particles);
  }
}

TEST(Sphere, isEnteredFromTheTop) {
  const Organ organ = buildOrgan(sphereScene(200));
  EXPECT_EQ(organ.entry, Eigen::Vector3d(0, 0, 0.05));
  EXPECT_EQ(organ.entry_axis, Eigen::Vector3d(0, 0, -1));
}

TEST(OrganBuilder, refusesNumbersOutOfRange) {
  Scene scene;
  scene.geometry.particles = 99;
  EXPECT_THROW(buildOrgan(scene), Error);
  scene.geometry.particles = 200001;
  EXPECT_THROW(buildOrgan(scene), Error);
  scene.geometry.particles = 200;
  for (const double volume : {0.0, -1.0, 1.0, std::nan("")}) {
    scene.geometry.volume = volume;
    EXPECT_THROW(buildOrgan(scene), Error);
  }
  Scene sphere = sphereScene(200);
  sphere.geometry.radius = -1;
  EXPECT_THROW(buildOrgan(sphere), Error);
}

}  // namespace
}  // namespace vibe::organ_builder_test
