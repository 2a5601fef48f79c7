#include "shading.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace vibe::python {

namespace {

using Rgb = Eigen::Vector3d;

// All colours are design choices: pale cardia and antrum, redder body; white marks, brown and black burns.
const std::array<Rgb, kRegionCount> kRegionAlbedo{Rgb(0.74, 0.34, 0.28), Rgb(0.60, 0.15, 0.12), Rgb(0.62, 0.17, 0.11),
                                                  Rgb(0.74, 0.30, 0.20), Rgb(0.70, 0.24, 0.17)};
const std::array<Rgb, 3> kBurnAlbedo{Rgb(0.98, 0.86, 0.74), Rgb(0.18, 0.06, 0.016), Rgb(0.005, 0.003, 0.002)};
constexpr double kMottle = 0.3;  // greatest share by which a particle is lighter or darker

// From -1 to 1, of the number of a particle (multiplicative hashing, Knuth 1998).
double spread(std::size_t particle) {
  const auto hashed = static_cast<std::uint32_t>(particle + 1) * 2654435761U;
  return static_cast<double>(hashed >> 8U) / (1U << 23U) - 1;
}

/// Weights of the corners of a triangle at a place in its plane, from the areas beside it.
Eigen::Vector3d weightsAt(const Eigen::Vector3d& place, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                          const Eigen::Vector3d& c) {
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  const double square = normal.squaredNorm();
  const double of_a = normal.dot((b - place).cross(c - place)) / square;
  const double of_b = normal.dot((c - place).cross(a - place)) / square;
  return {of_a, of_b, 1 - of_a - of_b};
}

constexpr double kClose = 0.004, kFar = 0.010;  // where light begins to go through the wall, too [m]
constexpr double kHalfWall = 0.0012, kFreePath = 0.001, kGuide = 0.0037;  // as in lamp.glsl of vibe_graphics [m]
const Rgb kAttenuation(400, 1000, 1200);                                  // [1/m]

/// 1 near the lens, 0 from kFar on.
double closeness(double distance) {
  const double t = std::clamp((distance - kClose) / (kFar - kClose), 0.0, 1.0);
  return 1 - t * t * (3 - 2 * t);
}

/// Of the light of a ring of guides around the lens, what comes out of the wall `aside` from the lens, whose face is
/// `gap` away: seeping() of lamp.glsl without direct light [1/m^2].
Rgb seeping(double gap, double aside) {
  const double deep = gap + kFreePath, way = std::sqrt(aside * aside + kGuide * kGuide + deep * deep);
  Rgb left = (1 + kAttenuation.array() * (kFreePath / deep * way - kFreePath) / 8).inverse();  // to the 8th: exp()
  for (int k = 0; k < 3; ++k) left = left.cwiseProduct(left);
  return deep / (way * way * way) * left;
}

/// Irradiance of a surface at `place`, of whatever side, by a lamp of unit intensity at the origin, for red, green and
/// blue [1/m^2].
Rgb irradiance(const Eigen::Vector3d& place, const Eigen::Vector3d& normal, bool is_wall) {
  const double square = place.squaredNorm(), distance = std::sqrt(square);
  const double height = std::abs(normal.dot(place)) / normal.norm(), close = is_wall ? closeness(distance) : 0;
  Rgb light = Rgb::Constant(height / (distance * square));
  if (close > 0)
    light += close *
             (seeping(std::max(height - kHalfWall, 0.0), std::sqrt(std::max(square - height * height, 0.0))) - light);
  return light;
}

std::uint8_t shown(double radiance) {
  return static_cast<std::uint8_t>(255 * std::sqrt(radiance / (1 + radiance)) + 0.5);
}

}  // namespace

std::vector<Eigen::Vector3d> wallAlbedo(const Model& model, const State& state) {
  const std::vector<std::uint8_t>& grade = state.procedure.grade;
  std::vector<Eigen::Vector3d> albedo(state.x.size());
  for (std::size_t i = 0; i < albedo.size(); ++i)
    albedo[i] = !grade.empty() && grade[i] > 0
                    ? kBurnAlbedo[grade[i] - 1U]
                    : (1 + kMottle * spread(i)) * kRegionAlbedo[static_cast<std::size_t>(model.organ.region[i])];
  return albedo;
}

void shade(const SurfaceView& surface, int walls, const std::vector<Eigen::Vector3d>& albedo,
           const Eigen::Isometry3d& camera, double field_of_view, double lamp, const CastImage& image,
           std::uint8_t* colour) {
  const Lens lens(image.width, image.height, field_of_view);
  const Eigen::Isometry3d to_camera = camera.inverse();
  SurfaceMesh seen{{}, surface.triangles};  // in the camera
  for (std::size_t i = 0; i < albedo.size(); ++i)
    seen.vertices.push_back(to_camera * surface.position(static_cast<int>(i)));
  const std::vector<Eigen::Vector3d> normals = vertexNormals(seen);
  for (int i = 0; i < image.width * image.height; ++i) {
    Rgb radiance = Rgb::Zero();
    if (image.triangle[i] >= 0) {
      const auto& t = surface.triangles[static_cast<std::size_t>(image.triangle[i])];
      const Eigen::Vector3d place = image.depth[i] * lens.ray(i % image.width, i / image.width);
      const Eigen::Vector3d weight = weightsAt(place, seen.vertices[t[0]], seen.vertices[t[1]], seen.vertices[t[2]]);
      const Eigen::Vector3d normal = weight[0] * normals[t[0]] + weight[1] * normals[t[1]] + weight[2] * normals[t[2]];
      radiance = (weight[0] * albedo[t[0]] + weight[1] * albedo[t[1]] + weight[2] * albedo[t[2]])
                     .cwiseMax(0)
                     .cwiseProduct(lamp * lamp * irradiance(place, normal, image.triangle[i] < walls));
    }
    for (int k = 0; k < 3; ++k) colour[3 * i + k] = shown(radiance[k]);
  }
}

}  // namespace vibe::python
