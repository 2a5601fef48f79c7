#include "geometry/ray.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace vibe {
namespace {

/// Box around a ray.
struct Box {
  Eigen::Array3d low, high;

  explicit Box(const Ray& ray) {
    const Eigen::Array3d a = ray.start.array(), b = ray.at(ray.length).array();
    low = a.min(b);
    high = a.max(b);
  }

  /// Whether the boxes of the triangle and of the ray are disjoint; true for corners that are not numbers.
  bool farFrom(const std::vector<double>& values, int axis, const std::array<int, 3>& t) const {
    const double p = values[t[0]], q = values[t[1]], r = values[t[2]];
    const bool reaches =
        (p >= low[axis] || q >= low[axis] || r >= low[axis]) && (p <= high[axis] || q <= high[axis] || r <= high[axis]);
    return !reaches;
  }
};

/// Distance along the ray to the triangle (Moeller and Trumbore 1997), negative if the ray misses it.
double meet(const Ray& ray, const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const Eigen::Vector3d ab = b - a, ac = c - a, h = ray.direction.cross(ac), s = ray.start - a, q = s.cross(ab);
  const double det = ab.dot(h);
  if (!(std::abs(det) > 0)) return -1;
  const double u = s.dot(h) / det, v = ray.direction.dot(q) / det;
  return u >= 0 && v >= 0 && u + v <= 1 ? ac.dot(q) / det : -1;
}

}  // namespace

Ray::Ray(const Eigen::Vector3d& from, const Eigen::Vector3d& unit, double reach)
    : start(from), direction(unit), length(reach) {}

Eigen::Vector3d areaVector(const SurfaceView& surface, const std::array<int, 3>& t) {
  const Eigen::Vector3d a = surface.position(t[0]);
  return (surface.position(t[1]) - a).cross(surface.position(t[2]) - a);
}

RayHit firstHit(const Ray& ray, const SurfaceView& surface) {
  const Box box(ray);
  RayHit hit{-1, ray.length};
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    const auto& t = surface.triangles[i];
    if (box.farFrom(surface.x, 0, t) || box.farFrom(surface.y, 1, t) || box.farFrom(surface.z, 2, t)) continue;
    const double length = meet(ray, surface.position(t[0]), surface.position(t[1]), surface.position(t[2]));
    if (!(length >= 0 && length <= hit.distance)) continue;
    if (length == hit.distance && hit.triangle >= 0) continue;
    hit = {static_cast<int>(i), length};
  }
  return hit;
}

}  // namespace vibe
