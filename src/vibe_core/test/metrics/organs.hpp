#pragma once
#include <cmath>
#include <functional>
#include <vector>

#include "vibe_core/geometry/organ.hpp"

/// Organs whose measures are known.
namespace vibe::test {

/// Surface of revolution around z from z = 0 (the fundus) down to z = -length (the pylorus), closed by flat caps where
/// the radius at an end is not zero; all body, without ends that are held.
inline Organ revolve(const std::function<double(double)>& radius, double length, int rings = 96, int sectors = 96) {
  Organ organ;
  SurfaceMesh& mesh = organ.surface;
  mesh.vertices.emplace_back(0, 0, 0);
  const int caps = 6;  // rings on each cap, so that it is not one fan
  std::vector<std::pair<double, double>> profile;
  for (int i = 1; i < caps; ++i) profile.emplace_back(radius(0) * i / caps, 0);
  for (int i = 0; i <= rings; ++i) profile.emplace_back(radius(length * i / rings), -length * i / rings);
  for (int i = caps - 1; i > 0; --i) profile.emplace_back(radius(length) * i / caps, -length);
  std::vector<std::pair<double, double>> used;  // a pointed end has no cap
  for (const auto& p : profile)
    if (p.first > 1e-9) used.push_back(p);
  for (const auto& [r, z] : used)
    for (int s = 0; s < sectors; ++s)
      mesh.vertices.emplace_back(r * std::cos(2 * M_PI * s / sectors), r * std::sin(2 * M_PI * s / sectors), z);
  mesh.vertices.emplace_back(0, 0, -length);
  const int last = static_cast<int>(mesh.vertices.size()) - 1, count = static_cast<int>(used.size());
  const auto at = [&](int ring, int s) { return 1 + ring * sectors + s % sectors; };
  for (int s = 0; s < sectors; ++s) {
    mesh.triangles.push_back({0, at(0, s), at(0, s + 1)});
    mesh.triangles.push_back({last, at(count - 1, s + 1), at(count - 1, s)});
    for (int r = 0; r + 1 < count; ++r) {
      mesh.triangles.push_back({at(r, s), at(r + 1, s), at(r + 1, s + 1)});
      mesh.triangles.push_back({at(r, s), at(r + 1, s + 1), at(r, s + 1)});
    }
  }
  const std::size_t n = mesh.vertices.size();
  organ.region.assign(n, Region::Body);
  organ.wall.assign(n, Wall::Anterior);
  organ.end.assign(n, End::None);
  organ.thickness.assign(n, 2e-3);
  organ.landmarks.pylorus = Eigen::Vector3d(0, 0, -length);
  return organ;
}

/// Positions of an organ's vertices after a map, as the simulator holds them.
struct Positions {
  std::vector<double> x, y, z;

  Positions(const Organ& organ, const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& map) {
    for (const auto& vertex : organ.surface.vertices) {
      const Eigen::Vector3d p = map(vertex);
      x.push_back(p.x());
      y.push_back(p.y());
      z.push_back(p.z());
    }
  }
};

}  // namespace vibe::test
