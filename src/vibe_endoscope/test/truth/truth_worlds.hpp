#pragma once
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "truth/truth_camera.hpp"
#include "vibe_graphics/geometry/solid_bodies.hpp"
#include "vibe_graphics/geometry/suture_shapes.hpp"
#include "vibe_graphics/testing/surfaces.hpp"

namespace vibe::endoscope::test {

// A hollow organ with folds, two rigid bodies and a thread in it, of which everything is known, and a caster of rays
// that shares nothing with the one that is tested: every ray against every triangle, in double precision.

constexpr double kNear = 0.0006, kFar = 2;

inline graphics::RoundCamera smallCamera(graphics::LensKind lens, int width = 160, int height = 120) {
  graphics::RoundCamera round;
  round.lens = lens, round.width = width, round.height = height;
  round.field_of_view = lens == graphics::LensKind::Equidistant ? 2.443461 : 1.6;
  return round;
}

/// Name of a test with a lens.
inline std::string lensName(const ::testing::TestParamInfo<graphics::LensKind>& info) {
  return info.param == graphics::LensKind::Equidistant ? "Equidistant" : "Rectilinear";
}

/// The ball with a radius of 50 mm and folds that `time` moves.
inline graphics::TissueFrame foldedFrame(const graphics::TissueMesh& mesh, const std::vector<float>& unit,
                                         double time) {
  graphics::TissueFrame frame;
  frame.revision = mesh.revision;
  for (std::size_t i = 0; i < mesh.particle_count; ++i) {
    const Eigen::Vector3d p = Eigen::Map<const Eigen::Vector3f>(&unit[3 * i]).cast<double>();
    const double fold = 0.06 * std::sin(7 * p.z() + 3 * p.x() + time) + 0.04 * time * p.y();
    for (int c = 0; c < 3; ++c) frame.positions.push_back(static_cast<float>(0.05 * (1 + fold) * p[c]));
    frame.grade.push_back(p.x() > 0.9 ? 1 : p.y() > 0.93 ? 2 : 0);
  }
  return frame;
}

/// Positions of the particles of ballMesh() and subdividedBall(), on the unit sphere.
inline std::vector<float> unitBall(std::uint32_t rows, std::uint32_t around) {
  return graphics::test::ballMesh(rows, around).rest;
}

/// An organ with anatomy: regions by height, walls by azimuth.
inline graphics::TissueMesh organ(std::uint32_t rows, std::uint32_t around) {
  graphics::TissueMesh mesh = graphics::test::subdividedBall(rows, around);
  const std::vector<float> unit = unitBall(rows, around);
  for (std::size_t i = 0; i < mesh.particle_count; ++i) {
    mesh.region.push_back(static_cast<std::uint8_t>(std::min(4.0, 2.5 * (1 + double(unit[3 * i + 2])))));
    const double azimuth = std::atan2(double(unit[3 * i + 1]), double(unit[3 * i]));
    mesh.wall.push_back(static_cast<std::uint8_t>(std::min(3.0, 2 * (azimuth / M_PI + 1))));
  }
  return mesh;
}

/// A camera near the middle that looks along x of the organ, turned a little.
inline Eigen::Isometry3d eye(double time = 0) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translate(Eigen::Vector3d(-0.012 + 0.002 * time, 0.004, -0.003 - 0.001 * time));
  Eigen::Matrix3d turn;
  turn.col(0) = Eigen::Vector3d(0, -1, 0), turn.col(1) = Eigen::Vector3d(0, 0, -1),
  turn.col(2) = Eigen::Vector3d(1, 0, 0);
  pose.linear() = Eigen::AngleAxisd(0.07 + 0.03 * time, Eigen::Vector3d(0.2, 0.3, 1).normalized()) * turn;
  return pose;
}

inline graphics::ColouredShape rodShape() {
  graphics::ColouredShape shape;
  graphics::appendCylinder(Eigen::Isometry3d(Eigen::Translation3d(0.004, 0, 0)), 0.003, 0.02, graphics::packed(1, 1, 1),
                           shape);
  return shape;
}
inline graphics::ColouredShape boxShape() {
  graphics::ColouredShape shape;
  graphics::appendBox(Eigen::Isometry3d::Identity(), {0.006, 0.004, 0.005}, graphics::packed(1, 1, 1), shape);
  return shape;
}
inline Eigen::Isometry3d rodPose(double time) {
  return Eigen::Translation3d(0.014, 0.012 - 0.002 * time, 0.004) *
         Eigen::Isometry3d(Eigen::AngleAxisd(0.6 + 0.1 * time, Eigen::Vector3d(1, 0.5, 0.2).normalized()));
}
inline Eigen::Isometry3d boxPose(double time) {
  return Eigen::Translation3d(0.02, -0.01, -0.008 + 0.003 * time) *
         Eigen::Isometry3d(Eigen::AngleAxisd(1.1, Eigen::Vector3d(0.3, 1, 0.1).normalized()));
}

/// One thread with a T-tag; without blood.
inline graphics::SutureDrawing thread(double time) {
  graphics::SutureDrawing scene;
  graphics::SutureSet& set = scene.sets.emplace_back();
  const Eigen::Vector3d bites[2] = {{0.025, 0.004, 0.012}, {0.028, -0.006, 0.010 + 0.001 * time}};
  for (const Eigen::Vector3d& place : bites) set.bites.push_back({place, true, -Eigen::Vector3d::UnitX()});
  set.pieces.push_back({{bites[0], {0.024, -0.001, 0.013}, bites[1]}, 1.0});
  set.has_t_tag = true, set.t_tag = bites[1];
  return scene;
}

/// The scene at a time, ready to be looked at.
class FoldedWorld {
 public:
  FoldedWorld(std::uint32_t rows, std::uint32_t around, bool things = true)
      : mesh_(organ(rows, around)), unit_(unitBall(rows, around)) {
    scene.setMesh(mesh_);
    if (!things) return;
    parts_ = {scene.addPart("rod", rodShape()), scene.addPart("box", boxShape())};
  }
  void show(double time) {
    frame = foldedFrame(mesh_, unit_, time);
    scene.setFrame(frame);
    if (!parts_.empty()) {
      scene.setSutures(thread(time), time, Eigen::Isometry3d::Identity());
      scene.placePart(parts_[0], rodPose(time));
      scene.placePart(parts_[1], boxPose(time));
    }
    scene.commit();
  }
  const graphics::TissueMesh& mesh() const { return mesh_; }

  TruthScene scene;
  graphics::TissueFrame frame;

 private:
  graphics::TissueMesh mesh_;
  std::vector<float> unit_;
  std::vector<std::uint32_t> parts_;
};

/// What the independent caster has hit.
struct PlainHit {
  std::size_t triangle = 0;
  double distance = 0;
  Eigen::Vector3d weight;  ///< barycentric
  Eigen::Vector3d place;
};

/// Triangles as corners in the frame of the scene.
struct PlainSurface {
  std::vector<Eigen::Vector3d> corners;  ///< three per triangle

  void add(const graphics::ColouredShape& shape, const Eigen::Isometry3d& pose) {
    for (const std::uint32_t v : shape.triangles)
      corners.push_back(pose * Eigen::Map<const Eigen::Vector3f>(shape.vertices[v].position).cast<double>());
  }
  /// The drawn surface of the organ by its definition: the weighted sum of particles.
  void add(const graphics::TissueMesh& mesh, const graphics::TissueFrame& frame) {
    for (const std::uint32_t v : mesh.triangles) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (std::uint32_t k = mesh.render_offsets[v]; k < mesh.render_offsets[v + 1]; ++k)
        sum += double(mesh.render_weights[k]) *
               Eigen::Map<const Eigen::Vector3f>(&frame.positions[3 * mesh.render_particles[k]]).cast<double>();
      corners.push_back(sum);
    }
  }

  /// By the volumes of three tetrahedra, the signs of which tell whether the ray passes inside of the triangle.
  std::optional<PlainHit> firstHit(const Eigen::Vector3d& origin, const Eigen::Vector3d& ray, double begin,
                                   double end) const {
    std::optional<PlainHit> first;
    for (std::size_t t = 0; 3 * t < corners.size(); ++t) {
      const Eigen::Vector3d a = corners[3 * t] - origin, b = corners[3 * t + 1] - origin,
                            c = corners[3 * t + 2] - origin;
      const Eigen::Vector3d volume(ray.dot(b.cross(c)), ray.dot(c.cross(a)), ray.dot(a.cross(b)));
      if ((volume.array() < 0).any() && (volume.array() > 0).any()) continue;
      const double sum = volume.sum();
      if (sum == 0) continue;
      const Eigen::Vector3d weight = volume / sum;
      const Eigen::Vector3d place = weight[0] * a + weight[1] * b + weight[2] * c;
      const double distance = place.dot(ray);
      if (distance < begin || distance > end || (first && distance >= first->distance)) continue;
      first = PlainHit{t, distance, weight, origin + place};
    }
    return first;
  }
};

/// What a pixel of a camera sees, by the independent caster.
inline std::optional<PlainHit> plainHit(const PlainSurface& surface, const graphics::RoundCamera& round,
                                        const Eigen::Isometry3d& pose, const Eigen::Vector2d& pixel) {
  const Eigen::Vector3d ray = graphics::rayOf(round, pixel);
  return surface.firstHit(pose.translation(), pose.linear() * ray, kNear / ray.z(), kFar / ray.z());
}

/// Everything in the FoldedWorld at a time; the organ first, then the rod, the box, and with `sutures` the thread.
inline PlainSurface plainWorld(const FoldedWorld& world, double time, bool sutures = true) {
  PlainSurface surface;
  surface.add(world.mesh(), world.frame);
  surface.add(rodShape(), rodPose(time));
  surface.add(boxShape(), boxPose(time));
  graphics::ColouredShape drawn;
  graphics::SutureStyle style;
  style.colouring = graphics::ThreadColour::One, style.bites = style.corners = false;
  if (sutures) graphics::appendSutures(thread(time), style, drawn);
  surface.add(drawn, Eigen::Isometry3d::Identity());
  return surface;
}

}  // namespace vibe::endoscope::test
