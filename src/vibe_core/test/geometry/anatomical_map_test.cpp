// Anatomical coordinates of a stomach in its present shape.
#include "vibe_core/geometry/anatomical_map.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "vibe_core/builder/model_builder.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/scene/scene.hpp"
#include "vibe_core/scene/scene_parser.hpp"

namespace vibe::anatomical_map_test {
namespace {

const Organ& stomach() {
  static const Organ organ = [] {
    Scene scene;
    scene.geometry.particles = 2000;
    scene.attach_oesophagus = scene.attach_duodenum = true;
    return buildOrgan(scene, {});
  }();
  return organ;
}

std::vector<Eigen::Vector3d> rest() {
  return stomach().surface.vertices;
}

TEST(AnatomicalMap, FindsThePlacesThatItsCoordinatesName) {
  const AnatomicalMap map(stomach(), rest());
  for (const double along : {0.25, 0.4, 0.5, 0.6})
    for (const double around : {-2.0, -1.0, 0.0, 1.0, 2.0}) {
      const WallPoint point = map.at(along, around);
      EXPECT_NEAR(map.along(point), along, 0.005);
      EXPECT_NEAR(map.around(point), around, 0.03) << along;
      EXPECT_NEAR(point.weight.sum(), 1, 1e-12);
      EXPECT_GE(point.weight.minCoeff(), -1e-9);
    }
}

TEST(AnatomicalMap, WallsLieWhereTheAnglesSay) {
  const AnatomicalMap map(stomach(), rest());
  const auto wallAt = [&](double around) {
    const WallPoint point = map.at(0.5, around);
    return stomach().wall[stomach().surface.triangles[point.triangle][0]];
  };
  EXPECT_EQ(wallAt(0), Wall::GreaterCurvature);
  EXPECT_EQ(wallAt(M_PI / 2), Wall::Anterior);
  EXPECT_EQ(wallAt(-M_PI / 2), Wall::Posterior);
  EXPECT_EQ(wallAt(M_PI), Wall::LesserCurvature);
}

TEST(AnatomicalMap, WalksAsFarAsAsked) {
  const AnatomicalMap map(stomach(), rest());
  const WallPoint begin = map.at(0.45, 0);
  for (const double way : {-0.02, 0.01, 0.03}) {
    const WallPoint distal = map.walk(begin, way, 0), anterior = map.walk(begin, 0, way);
    // the chord of an arc with a radius of at least 35 mm
    EXPECT_NEAR((map.position(distal) - map.position(begin)).norm(), std::abs(way), 0.05 * std::abs(way));
    EXPECT_NEAR((map.position(anterior) - map.position(begin)).norm(), std::abs(way), 0.05 * std::abs(way));
    EXPECT_GT((map.along(distal) - map.along(begin)) * way, 0);
    EXPECT_GT((map.around(anterior) - map.around(begin)) * way, 0);
    EXPECT_NEAR(map.along(anterior), map.along(begin), 0.01) << "across the axis";
    EXPECT_NEAR(map.around(distal), map.around(begin), 0.15) << "along the axis";
  }
}

TEST(AnatomicalMap, WalkingBackLeadsHome) {
  const AnatomicalMap map(stomach(), rest());
  const WallPoint begin = map.at(0.5, 0.3);
  const WallPoint back = map.walk(map.walk(begin, 0, 0.03), 0, -0.03);
  EXPECT_NEAR((map.position(back) - map.position(begin)).norm(), 0, 1e-3);
}

TEST(AnatomicalMap, CoordinatesGoWithTheOrgan) {
  // moved, turned about the front-to-back axis and larger: the same places have the same coordinates
  const Eigen::AngleAxisd turn(0.4, stomach().landmarks.anterior);
  std::vector<Eigen::Vector3d> moved;
  for (const Eigen::Vector3d& p : rest()) moved.push_back(1.15 * (turn * p) + Eigen::Vector3d(0.1, -0.2, 0.3));
  const AnatomicalMap map(stomach(), rest()), other(stomach(), moved);
  // the patch around the apex, where the axis begins, has a fixed size
  EXPECT_NEAR(other.axisLength(), 1.15 * map.axisLength(), 1e-2 * map.axisLength());
  for (const double around : {-1.0, 0.0, 1.0}) {
    const WallPoint a = map.at(0.5, around), b = other.at(0.5, around);
    const Eigen::Vector3d expected = 1.15 * (turn * map.position(a)) + Eigen::Vector3d(0.1, -0.2, 0.3);
    EXPECT_NEAR((other.position(b) - expected).norm(), 0, 2e-3) << around;
  }
}

TEST(AnatomicalMap, NormalsLeadOutOfTheLumen) {
  const AnatomicalMap map(stomach(), rest());
  for (const double around : {-1.5, 0.0, 1.5}) {
    const WallPoint point = map.at(0.5, around), opposite = map.at(0.5, around + M_PI);
    EXPECT_NEAR(map.outward(point).norm(), 1, 1e-12);
    EXPECT_GT(map.outward(point).dot((map.position(point) - map.position(opposite)).normalized()), 0.8);
  }
}

TEST(AnatomicalMap, SharesOfARegionLieInIt) {
  const AnatomicalMap map(stomach(), rest());
  const auto regionAt = [&](Region region, double share) {
    const WallPoint point = map.at(map.alongIn(region, share), 0);
    return stomach().region[stomach().surface.triangles[point.triangle][0]];
  };
  for (const Region region : {Region::Fundus, Region::Body, Region::Antrum, Region::Pylorus})
    for (const double share : {0.2, 0.5, 0.8}) EXPECT_EQ(regionAt(region, share), region) << toString(region) << share;
  EXPECT_LT(map.alongIn(Region::Body, 0), map.alongIn(Region::Body, 1));
  Organ without = stomach();
  std::replace(without.region.begin(), without.region.end(), Region::Antrum, Region::Body);
  const AnatomicalMap other(without, rest());
  EXPECT_THROW(other.alongIn(Region::Antrum, 0.5), Error);
  EXPECT_NO_THROW(other.alongIn(Region::Body, 0.5));
}

TEST(AnatomicalMap, PlacesBeyondTheOrganAreErrors) {
  const AnatomicalMap map(stomach(), rest());
  for (const double along : {-0.01, 1.01, std::nan("")}) EXPECT_THROW(map.at(along, 0), Error) << along;
  EXPECT_THROW(map.at(0.5, std::nan("")), Error);
  EXPECT_NO_THROW(map.at(0, 0));    // the apex
  EXPECT_NO_THROW(map.at(0.5, 7));  // once around and a bit
  EXPECT_NEAR(map.around(map.at(0.5, 7)), 7 - 2 * M_PI, 0.03);
  std::vector<Eigen::Vector3d> fewer = rest();
  fewer.pop_back();
  EXPECT_THROW(AnatomicalMap(stomach(), fewer), Error);
}

std::string walkError(const AnatomicalMap& map, const WallPoint& from, double distal, double anterior) {
  try {
    map.walk(from, distal, anterior);
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

TEST(AnatomicalMap, WalksThatLeaveTheOrganAreErrors) {
  const AnatomicalMap map(stomach(), rest());
  EXPECT_EQ(walkError(map, map.at(0.3, 0), -0.03, 0), "");
  EXPECT_NE(walkError(map, map.at(0.1, 0), -0.2, 0).find("over the apex of the fundus"), std::string::npos);
  EXPECT_NE(walkError(map, map.at(0.8, 0), 0.2, 0).find("The organ ends after"), std::string::npos);
  EXPECT_NE(walkError(map, map.at(0.5, 0), 0, 0.3).find("more than half around"), std::string::npos);
  EXPECT_EQ(walkError(map, map.at(0.5, 0), 0, 0.08), "");
}

// Every place that a sleeve needs, on every organ.
TEST(AnatomicalMap, FindsItsPlacesOnEveryShippedStomach) {
  for (const char* name : {"stomach_small", "stomach_large", "stomach_j", "stomach_steer_horn"}) {
    const Organ organ = buildOrgan(loadScene(std::string(VIBE_CORE_DIR) + "/scenes/" + name + ".yaml"));
    const AnatomicalMap map(organ, organ.surface.vertices);
    for (double along = 0.05; along < 0.93; along += 0.04)
      for (const double around : {-1.2, -0.6, 0.0, 0.6, 1.2}) {
        const WallPoint point = map.at(along, around);
        EXPECT_NEAR(map.along(point), along, 0.01) << name;
        EXPECT_NEAR(map.around(point), around, 0.06) << name << " along " << along;
        if (along < 0.15 || along > 0.75) continue;
        const WallPoint there = map.walk(point, 6e-3, 0), across = map.walk(point, 0, 0.012);
        EXPECT_NEAR((map.position(there) - map.position(point)).norm(), 6e-3, 1e-3) << name << " along " << along;
        EXPECT_NEAR((map.position(across) - map.position(point)).norm(), 0.012, 2e-3) << name << " along " << along;
        EXPECT_LT((map.position(map.walk(there, -6e-3, 0)) - map.position(point)).norm(), 1e-3) << name << along;
      }
    EXPECT_NO_THROW(map.at(0, 0)) << name;
    EXPECT_THROW(map.walk(map.at(0.85, 0), 0.2, 0), Error) << name;
    EXPECT_THROW(map.walk(map.at(0.15, 0), -0.25, 0), Error) << name;
  }
}

Organ stomachOf(const std::string& shape, int particles) {
  Scene scene = loadScene(std::string(VIBE_CORE_DIR) + "/scenes/" + shape + ".yaml");
  scene.geometry.particles = particles;
  return buildOrgan(scene);
}

// The bites of a sleeve: six rows of three across the greater curvature of the body.
// From the incisura: each mesh has its own centre.
std::vector<Eigen::Vector3d> bitesOn(const Organ& organ) {
  const AnatomicalMap map(organ, organ.surface.vertices);
  std::vector<Eigen::Vector3d> bites;
  for (const double share : {0.08, 0.25, 0.42, 0.58, 0.75, 0.91})
    for (const double anterior : {-0.03, 0.0, 0.03})
      bites.push_back(map.position(map.walk(map.at(map.alongIn(Region::Body, share), 0), 0, anterior)) -
                      organ.landmarks.incisura);
  return bites;
}

// A polyhedron lies beside the wall that it stands for by the square of its edge over 8 radii: 0.6 mm with 300
// vertices. Most of the rest is where the oesophagus is cut out of the sections, along the edges of the mesh.
TEST(AnatomicalMap, AnotherMeshGivesTheSamePlaces) {
  for (const char* shape : {"stomach", "stomach_steer_horn"}) {
    const std::vector<Eigen::Vector3d> expected = bitesOn(stomachOf(shape, 8000));
    for (const auto& [particles, mean_limit] : {std::pair{300, 2.5e-3}, {1000, 2.5e-3}, {3000, 1e-3}}) {
      const std::vector<Eigen::Vector3d> bites = bitesOn(stomachOf(shape, particles));
      double squares = 0;
      for (std::size_t k = 0; k < bites.size(); ++k) {
        const double apart = (bites[k] - expected[k]).norm();
        EXPECT_LT(apart, 5e-3) << shape << ", " << particles << " particles, bite " << k;
        squares += apart * apart / static_cast<double>(bites.size());
      }
      EXPECT_LT(std::sqrt(squares), mean_limit) << shape << ", " << particles << " particles";
    }
  }
}

// Negative control: the last vertex before the border of a region, as a place, depends on the mesh.
TEST(AnatomicalMap, BordersAreNotAtVertices) {
  const auto bordersOf = [](int particles) {
    const Organ organ = stomachOf("stomach", particles);
    const AnatomicalMap map(organ, organ.surface.vertices);
    double last = 0;
    for (std::size_t v = 0; v < organ.region.size(); ++v) {
      const WallPoint point = map.atVertex(static_cast<int>(v));
      if (organ.region[v] == Region::Body && std::abs(map.around(point)) < M_PI / 4)
        last = std::max(last, map.along(point) * map.axisLength());
    }
    return std::pair(map.alongIn(Region::Body, 1) * map.axisLength(), last);
  };
  const auto coarse = bordersOf(300), fine = bordersOf(3000);
  EXPECT_NEAR(coarse.first, fine.first, 2e-3);
  EXPECT_GT(std::abs(coarse.second - fine.second), 3e-3);
}

TEST(AnatomicalMap, AnOrganWithoutEndsHasNoCoordinates) {
  Organ bare = stomach();
  bare.end.assign(bare.end.size(), End::None);
  try {
    AnatomicalMap(bare, bare.surface.vertices);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("geometry.landmarks"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace vibe::anatomical_map_test
