#pragma once
#include <cmath>
#include <cstdint>
#include <vector>

#include "vibe_graphics/geometry/tissue_mesh.hpp"

namespace vibe::graphics::test {

/// A straight organ along x: a tube of 200 mm without ends, triangles outward. Angle 0 is at z ("anterior"), a quarter
/// turn towards y is the greater curvature.
struct TubeOrgan {
  std::uint32_t rows = 80, around = 64;  ///< of particles: rows along it, particles around it
  double length = 0.2, radius = 0.04;    ///< [m]
  std::uint8_t region = 2;               ///< of all particles: REGION_BODY

  /// Positions of all particles, row by row, x y z each [m].
  /// @param wider, longer  factors of radius and length
  std::vector<float> places(double wider = 1, double longer = 1) const {
    std::vector<float> result;
    for (std::uint32_t r = 0; r < rows; ++r)
      for (std::uint32_t a = 0; a < around; ++a) {
        const double angle = angleOf(a);
        for (const double p : {longer * length * (r / (rows - 1.0) - 0.5), wider * radiusAt(r) * std::sin(angle),
                               wider * radiusAt(r) * std::cos(angle)})
          result.push_back(static_cast<float>(p));
      }
    return result;
  }

  /// Angle of particle `a` of each row, from z towards y [rad].
  double angleOf(std::uint32_t a) const { return 2 * 3.14159265358979 * a / around; }
  double waist = 0;  ///< depth of a waist in the middle of the tube [m]
  /// Radius of a row, with the waist [m].
  double radiusAt(std::uint32_t row) const {
    const double x = (row / (rows - 1.0) - 0.5) * length / 0.015;
    return radius - waist * std::exp(-x * x);
  }

  /// The organ at rest, without a render surface; all four walls, no ends.
  TissueMesh mesh() const {
    TissueMesh mesh;
    mesh.revision = 1;
    mesh.rest = mesh.particle_rest = places();
    mesh.particle_count = mesh.vertex_count = rows * around;
    for (std::uint32_t r = 0; r + 1 < rows; ++r)
      for (std::uint32_t a = 0; a < around; ++a) {
        const std::uint32_t b = (a + 1) % around, upper = r * around, lower = upper + around;
        mesh.triangles.insert(mesh.triangles.end(), {upper + a, lower + a, upper + b, lower + a, lower + b, upper + b});
      }
    mesh.particle_triangles = mesh.triangles;
    mesh.region.assign(mesh.particle_count, region);
    mesh.end.assign(mesh.particle_count, 0);
    for (std::uint32_t k = 0; k < mesh.particle_count; ++k)  // quarters around 0, 90, 180 and 270 degrees
      mesh.wall.push_back(static_cast<std::uint8_t>((k % around * 8 / around + 1) / 2 % 4));
    return mesh;
  }
};

}  // namespace vibe::graphics::test
