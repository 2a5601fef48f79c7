#pragma once
#include <cmath>
#include <cstdint>
#include <vector>

#include "vibe_graphics/geometry/tissue_mesh.hpp"

namespace vibe::graphics::test {

/// A ball of radius 1 m: rows of latitude with `around` particles each, and two poles. Outward triangles, no render
/// surface.
inline TissueMesh ballMesh(std::uint32_t rows, std::uint32_t around) {
  constexpr double kPi = 3.14159265358979;
  TissueMesh mesh;
  mesh.revision = 1;
  const auto add = [&mesh](double polar, double azimuth) {
    for (const double p : {std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar)})
      mesh.rest.push_back(static_cast<float>(p));
  };
  add(0, 0);
  for (std::uint32_t r = 1; r <= rows; ++r)
    for (std::uint32_t a = 0; a < around; ++a) add(kPi * r / (rows + 1), 2 * kPi * a / around);
  add(kPi, 0);
  const std::uint32_t last = rows * around + 1;
  for (std::uint32_t a = 0; a < around; ++a) {
    const std::uint32_t b = (a + 1) % around, bottom = (rows - 1) * around;
    mesh.triangles.insert(mesh.triangles.end(), {0, 1 + a, 1 + b, last, 1 + bottom + b, 1 + bottom + a});
    for (std::uint32_t r = 0; r + 1 < rows; ++r) {
      const std::uint32_t upper = 1 + r * around, lower = upper + around;
      mesh.triangles.insert(mesh.triangles.end(), {upper + a, lower + a, lower + b, upper + a, lower + b, upper + b});
    }
  }
  mesh.particle_triangles = mesh.triangles;
  mesh.particle_count = mesh.vertex_count = last + 1;
  mesh.particle_rest = mesh.rest;
  return mesh;
}

/// The same drawn with a render surface of as many vertices: half the particle itself, half the mean of the corners of
/// the first triangle it belongs to.
inline TissueMesh subdividedBall(std::uint32_t rows, std::uint32_t around) {
  TissueMesh mesh = ballMesh(rows, around);
  mesh.render_offsets.push_back(0);
  for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
    std::size_t t = 0;
    while (mesh.triangles[t] != v) ++t;
    t -= t % 3;
    for (std::size_t c = 0; c < 3; ++c) {
      mesh.render_particles.push_back(mesh.triangles[t + c]);
      mesh.render_weights.push_back(mesh.triangles[t + c] == v ? 2.0F / 3 : 1.0F / 6);
    }
    mesh.render_offsets.push_back(static_cast<std::uint32_t>(mesh.render_particles.size()));
  }
  return mesh;
}

}  // namespace vibe::graphics::test
