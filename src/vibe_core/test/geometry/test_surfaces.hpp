#pragma once
#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <utility>

#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe::test {

/// Axis-parallel box with its centre at the origin, 12 triangles.
inline SurfaceMesh makeBox(double x, double y, double z) {
  SurfaceMesh mesh;
  for (int k = 0; k < 8; ++k) {
    mesh.vertices.emplace_back((k & 1 ? 0.5 : -0.5) * x, (k & 2 ? 0.5 : -0.5) * y, (k & 4 ? 0.5 : -0.5) * z);
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

/// Sphere of latitudes and longitudes: needles at the poles, wide triangles at the equator.
inline SurfaceMesh makeUvSphere(double radius, int rings, int sectors) {
  SurfaceMesh mesh;
  mesh.vertices.emplace_back(0, 0, radius);
  for (int r = 1; r < rings; ++r) {
    for (int s = 0; s < sectors; ++s) {
      const double theta = M_PI * r / rings, phi = 2 * M_PI * s / sectors;
      mesh.vertices.emplace_back(radius * std::sin(theta) * std::cos(phi), radius * std::sin(theta) * std::sin(phi),
                                 radius * std::cos(theta));
    }
  }
  mesh.vertices.emplace_back(0, 0, -radius);
  const int last = static_cast<int>(mesh.vertices.size()) - 1;
  const auto at = [&](int r, int s) { return 1 + (r - 1) * sectors + s % sectors; };
  for (int s = 0; s < sectors; ++s) {
    mesh.triangles.push_back({0, at(1, s), at(1, s + 1)});
    mesh.triangles.push_back({last, at(rings - 1, s + 1), at(rings - 1, s)});
    for (int r = 1; r + 1 < rings; ++r) {
      mesh.triangles.push_back({at(r, s), at(r + 1, s), at(r + 1, s + 1)});
      mesh.triangles.push_back({at(r, s), at(r + 1, s + 1), at(r, s + 1)});
    }
  }
  return mesh;
}

/// Ring with one handle.
inline SurfaceMesh makeTorus(double large, double small, int around, int across) {
  SurfaceMesh mesh;
  for (int i = 0; i < around; ++i) {
    for (int k = 0; k < across; ++k) {
      const double u = 2 * M_PI * i / around, v = 2 * M_PI * k / across;
      const double r = large + small * std::cos(v);
      mesh.vertices.emplace_back(r * std::cos(u), r * std::sin(u), small * std::sin(v));
    }
  }
  const auto at = [&](int i, int k) { return (i % around) * across + k % across; };
  for (int i = 0; i < around; ++i) {
    for (int k = 0; k < across; ++k) {
      mesh.triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
      mesh.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
    }
  }
  return mesh;
}

/// Both surfaces in one, the second moved.
inline SurfaceMesh join(SurfaceMesh first, const SurfaceMesh& second, const Eigen::Vector3d& shift) {
  const int offset = static_cast<int>(first.vertices.size());
  for (const auto& v : second.vertices) first.vertices.push_back(v + shift);
  for (const auto& t : second.triangles) first.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  return first;
}

}  // namespace vibe::test
