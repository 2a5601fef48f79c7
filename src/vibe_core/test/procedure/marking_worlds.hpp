#pragma once
#include <algorithm>
#include <vector>

#include "vibe_core/thermal/argon_beam.hpp"
#include "vibe_core/thermal/thermal_dose.hpp"
#include "vibe_testing/worlds.hpp"

/// A wall, a beam and a dose in one line, for the tests of marking.
namespace vibe::test {

/// A sphere whose particles stand for 16.5 mm^2 each, as those of the default stomach with 3,618 particles (level 4:
/// 2,562 of them), or for 4.1 mm^2, as those of one with 15,000 (level 5).
inline SurfaceMesh markingBall(int level, double radius = 0.058) {
  return icosphere(radius, level);
}

struct MarkingWorld {
  static constexpr double kHalfWall = 1e-3, kGap = 3e-3;

  ApcParameters parameters;
  Organ organ;
  std::vector<double> x, y, z;
  ArgonBeam beam;
  std::vector<float> heat, dose;
  std::vector<Burn> burns;
  double delivered = 0;  ///< [J]

  explicit MarkingWorld(SurfaceMesh surface) : organ(plainOrgan(std::move(surface), 2e-3)), beam(organ.surface) {
    for (const Eigen::Vector3d& p : organ.surface.vertices) x.push_back(p.x()), y.push_back(p.y()), z.push_back(p.z());
    heat.assign(x.size(), 0);
    dose.assign(x.size(), 0);
  }

  SurfaceView wall() const { return {organ.surface.triangles, x, y, z}; }

  /// From inside a sphere around the origin, with the probe's end at a gap from the mucosa.
  const BeamHit& fireAt(const Eigen::Vector3d& point, double gap = kGap) {
    const Eigen::Vector3d out = point.normalized();
    const double from_middle = point.norm() - kHalfWall - gap - parameters.probe_length;
    return beam.fire(from_middle * out, out, wall(), kHalfWall, parameters);
  }

  /// Steps of dt; fire(time) is called in the middle of each and fires the beam.
  template <class Fire>
  void expose(double seconds, double dt, const Fire& fire) {
    const ThermalDose law(parameters);
    const long steps = std::lround(seconds / dt);
    for (long i = 0; i < steps; ++i) {
      fire((static_cast<double>(i) + 0.5) * dt);
      for (const BeamShare& share : beam.shares()) delivered += share.power * dt;
      law.advance(organ, beam.shares(), {parameters.argon_flow, 0}, dt, heat, dose, burns);
    }
  }
  /// Holds or moves the beam on a sphere: fires at place(time).
  template <class Place>
  void mark(double seconds, double dt, const Place& place) {
    expose(seconds, dt, [&](double time) { fireAt(place(time)); });
  }
  void hold(const Eigen::Vector3d& point, double seconds, double dt = 1.0 / 60) {
    mark(seconds, dt, [&](double) { return point; });
  }
  void wait(double seconds, double dt = 1.0 / 60) {
    const ThermalDose law(parameters);
    for (long i = 0; i < std::lround(seconds / dt); ++i) law.advance(organ, {}, {}, dt, heat, dose, burns);
  }

  float maxDose() const { return *std::max_element(dose.begin(), dose.end()); }
  BurnGrade worst() const { return ThermalDose(parameters).grade(maxDose()); }
};

/// A particle of the sphere, the middle of a side at it and that of a triangle: the best and the worst aim.
inline std::vector<Eigen::Vector3d> aims(const SurfaceMesh& mesh) {
  std::vector<Eigen::Vector3d> points;
  for (const std::size_t i : {std::size_t{100}, mesh.triangles.size() / 2, mesh.triangles.size() - 50}) {
    const auto& t = mesh.triangles[i];
    const Eigen::Vector3d a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
    points.insert(points.end(), {a, (a + b) / 2, (a + b + c) / 3});
  }
  return points;
}

}  // namespace vibe::test
