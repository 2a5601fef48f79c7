#include "vibe_operator/drive/mouse_ray.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <limits>

namespace vibe::operating {

namespace {

constexpr double kEdgeTolerance =
    1e-9;                              // tolerance of triangle edges, so that a ray does not pass between two triangles
constexpr double kMinDistance = 1e-6;  // hits closer to the origin are ignored [m]
constexpr double kMinSlope = 1e-9;     // between a ray and a plane that meet

using Corners = std::array<Eigen::Vector3d, 3>;

bool readCorners(const std::vector<float>& positions, const std::uint32_t* triangle, Corners& corners) {
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t at = 3 * static_cast<std::size_t>(triangle[k]);
    if (at + 2 >= positions.size()) return false;
    corners[k] = Eigen::Vector3d(positions[at], positions[at + 1], positions[at + 2]);
    if (!corners[k].allFinite()) return false;
  }
  return true;
}

// Moeller, Trumbore 1997. Negative: not met.
double distanceTo(const MouseRay& ray, const Corners& corners) {
  const Eigen::Vector3d a = corners[1] - corners[0], b = corners[2] - corners[0];
  const Eigen::Vector3d p = ray.direction.cross(b);
  const double volume = a.dot(p);
  if (volume == 0) return -1;
  const Eigen::Vector3d from = ray.origin - corners[0], q = from.cross(a);
  const double u = from.dot(p) / volume, v = ray.direction.dot(q) / volume;
  return u < -kEdgeTolerance || v < -kEdgeTolerance || u + v > 1 + kEdgeTolerance ? -1 : b.dot(q) / volume;
}

std::uint32_t nearestCorner(const Corners& corners, const std::uint32_t* triangle, const Eigen::Vector3d& place) {
  std::size_t nearest = 0;
  for (std::size_t k = 1; k < 3; ++k)
    if ((corners[k] - place).squaredNorm() < (corners[nearest] - place).squaredNorm()) nearest = k;
  return triangle[nearest];
}

}  // namespace

std::optional<MouseHit> firstHit(const MouseRay& ray, const std::vector<float>& positions,
                                 const std::vector<std::uint32_t>& triangles) {
  MouseHit hit;
  hit.distance = std::numeric_limits<double>::infinity();
  Corners corners;
  for (std::size_t t = 0; 3 * t + 2 < triangles.size(); ++t) {
    if (!readCorners(positions, &triangles[3 * t], corners)) continue;
    const double distance = distanceTo(ray, corners);
    if (!(distance > kMinDistance && distance < hit.distance)) continue;
    hit.triangle = t;
    hit.distance = distance;
    hit.place = ray.origin + distance * ray.direction;
    hit.particle = nearestCorner(corners, &triangles[3 * t], hit.place);
  }
  if (hit.distance == std::numeric_limits<double>::infinity()) return std::nullopt;
  return hit;
}

std::optional<Eigen::Vector3d> meetPlane(const MouseRay& ray, const Eigen::Vector3d& place,
                                         const Eigen::Vector3d& normal) {
  const double slope = normal.dot(ray.direction);
  if (std::abs(slope) < kMinSlope * normal.norm()) return std::nullopt;
  const double distance = normal.dot(place - ray.origin) / slope;
  if (!(distance > 0)) return std::nullopt;
  return Eigen::Vector3d(ray.origin + distance * ray.direction);
}

}  // namespace vibe::operating
