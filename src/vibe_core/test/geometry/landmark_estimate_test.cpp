#include "geometry/regions.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "geometry/remesh.hpp"
#include "geometry/stomach_knots.hpp"
#include "vibe_core/builder/model_builder.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::landmark_estimate_test {
namespace {

const Organ& stomach(const std::string& shape) {
  static std::map<std::string, Organ> organs;
  if (organs.count(shape) == 0) {
    Scene scene;
    scene.geometry.particles = 1500;
    scene.geometry.shape = shape;
    organs.emplace(shape, buildOrgan(scene));
  }
  return organs.at(shape);
}

SurfaceMesh changed(SurfaceMesh mesh, const Eigen::Matrix3d& map) {
  for (auto& v : mesh.vertices) v = map * v;
  if (map.determinant() < 0)
    for (auto& t : mesh.triangles) std::swap(t[0], t[1]);
  return mesh;
}

Eigen::Matrix3d turn(double degrees, int axis) {
  return Eigen::AngleAxisd(degrees * M_PI / 180, Eigen::Vector3d::Unit(axis)).toRotationMatrix();
}

double worstError(const LandmarkEstimate& estimate, const Landmarks& stated, const Eigen::Matrix3d& map) {
  const Landmarks& l = estimate.landmarks;
  return std::max({(l.oesophagus - map * stated.oesophagus).norm(), (l.fundus - map * stated.fundus).norm(),
                   (l.incisura - map * stated.incisura).norm(), (l.pylorus - map * stated.pylorus).norm()});
}

/// 0 for a surface that is refused.
double confidenceOf(const SurfaceMesh& mesh) {
  try {
    return estimateLandmarks(mesh).confidence;
  } catch (const Error&) {
    return 0;
  }
}

TEST(LandmarkEstimate, FindsThoseOfEveryShape) {
  for (const std::string& shape : stomachShapes()) {
    const LandmarkEstimate estimate = estimateLandmarks(stomach(shape).surface);
    EXPECT_LT(worstError(estimate, stomach(shape).landmarks, Eigen::Matrix3d::Identity()), 0.04) << shape;
    EXPECT_LT((estimate.landmarks.fundus - stomach(shape).landmarks.fundus).norm(), 0.005) << shape;
  }
  EXPECT_EQ(estimateLandmarks(stomach("sthenic").surface).confidence, 1);
  EXPECT_EQ(estimateLandmarks(stomach("j").surface).confidence, 1);
  // the lesser curvature of a steer horn has no clear angle: its incisura is less sure than anything else
  const LandmarkEstimate horn = estimateLandmarks(stomach("steer_horn").surface);
  EXPECT_LT(horn.confidence, 0.8);
  EXPECT_EQ(horn.doubt, "its landmarks move when its axes are tilted");
  EXPECT_GT(horn.spread[2], 0.03);
  for (const int place : {0, 1, 3}) EXPECT_LT(horn.spread[static_cast<std::size_t>(place)], 0.03);
}

TEST(LandmarkEstimate, WhoIsSureIsRight) {
  // tilted by up to 40 degrees: what confidence is worth
  int sure = 0;
  for (const std::string& shape : stomachShapes())
    for (int axis = 0; axis < 3; ++axis)
      for (const double degrees : {-40.0, -20.0, 20.0, 40.0}) {
        const Eigen::Matrix3d map = turn(degrees, axis);
        const SurfaceMesh mesh = changed(stomach(shape).surface, map);
        if (confidenceOf(mesh) < kSureLandmarks) continue;
        ++sure;
        EXPECT_LT(worstError(estimateLandmarks(mesh), stomach(shape).landmarks, map), 0.045)
            << shape << " axis " << axis << " by " << degrees;
      }
  EXPECT_GT(sure, 18) << "of 36";
}

TEST(LandmarkEstimate, IsNotSureOfAStomachInOtherAxes) {
  const std::map<std::string, Eigen::Matrix3d> others{{"mirrored", Eigen::Vector3d(1, -1, 1).asDiagonal()},
                                                      {"mirrored upside down", Eigen::Vector3d(1, 1, -1).asDiagonal()},
                                                      {"from the side", turn(90, 2)},
                                                      {"from the other side", turn(-90, 2)},
                                                      {"from behind", turn(180, 2)},
                                                      {"upside down", turn(180, 0)},
                                                      {"feet first, from behind", turn(180, 1)},
                                                      {"lying", turn(90, 0)},
                                                      {"lying on its face", turn(90, 1)}};
  for (const std::string& shape : stomachShapes())
    for (const auto& [name, map] : others)
      EXPECT_LT(confidenceOf(changed(stomach(shape).surface, map)), kSureLandmarks) << shape << " " << name;
}

TEST(LandmarkEstimate, IsNotSureOfAPart) {
  for (const std::string& shape : {std::string("sthenic"), std::string("j")}) {
    SurfaceMesh no_antrum = stomach(shape).surface, no_fundus = no_antrum;
    double right = 0, top = 0;
    for (const auto& v : no_antrum.vertices) right = std::min(right, v.y()), top = std::max(top, v.z());
    for (auto& v : no_antrum.vertices) v.y() = std::max(v.y(), 0.5 * right);
    for (auto& v : no_fundus.vertices) v.z() = std::min(v.z(), 0.4 * top);
    EXPECT_LT(confidenceOf(remeshSurface(no_antrum, 1500, nullptr, {})), kSureLandmarks) << shape;
    EXPECT_LT(confidenceOf(remeshSurface(no_fundus, 1500, nullptr, {})), kSureLandmarks) << shape;
  }
}

TEST(LandmarkEstimate, RefusesWhatIsNoStomach) {
  Scene scene;
  scene.geometry.kind = GeometryScene::Kind::Sphere;
  scene.geometry.particles = 1000;
  const SurfaceMesh ball = buildOrgan(scene).surface;
  EXPECT_THROW(estimateLandmarks(ball), Error);
  for (const double length : {2.0, 4.0}) {
    const SurfaceMesh tube = changed(ball, Eigen::Vector3d(1, 1, length).asDiagonal());
    EXPECT_THROW(estimateLandmarks(tube), Error) << length;
    EXPECT_LT(confidenceOf(changed(tube, turn(35, 0))), kSureLandmarks) << length;
  }
}

}  // namespace
}  // namespace vibe::landmark_estimate_test
