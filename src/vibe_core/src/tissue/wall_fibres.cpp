#include "tissue/wall_fibres.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "common/elementary.hpp"
#include "geometry/regions.hpp"
#include "vibe_core/common/error.hpp"

namespace vibe {
namespace {

Eigen::Vector3d tangentAt(const StomachAxis& axis, double length) {
  const auto& stations = axis.stations();
  const auto after = std::lower_bound(stations.begin(), stations.end(), length,
                                      [](const StomachAxis::Station& s, double at) { return s.length < at; });
  if (after == stations.begin()) return stations.front().tangent;
  if (after == stations.end()) return stations.back().tangent;
  const auto before = after - 1;
  const double part = (length - before->length) / (after->length - before->length);
  return ((1 - part) * before->tangent + part * after->tangent).normalized();
}

// Direction of the long axis next to every vertex.
std::vector<Eigen::Vector3d> axisDirections(const Organ& organ) {
  const std::size_t count = organ.surface.vertices.size();
  if (std::find(organ.end.begin(), organ.end.end(), End::Duodenum) == organ.end.end()) {
    const Eigen::Vector3d line = organ.landmarks.pylorus - organ.landmarks.fundus;
    if (!(line.norm() > 0))
      throw Error(
          "tissue.fibres needs the organ's long axis, but its fundus and pylorus are one point; set them apart.");
    return std::vector<Eigen::Vector3d>(count, line.normalized());
  }
  const StomachAxis axis = findAxis(organ);
  std::vector<Eigen::Vector3d> out;
  for (std::size_t v = 0; v < count; ++v) out.push_back(tangentAt(axis, axis.lengthAt(static_cast<int>(v))));
  return out;
}

}  // namespace

ShellFibres wallFibres(const FibreScene& scene, const Organ& organ, const std::vector<double>& factor) {
  const std::vector<Eigen::Vector3d> axis = axisDirections(organ);
  ShellFibres fibres;
  fibres.stiffening = scene.stiffening;
  for (std::size_t e = 0; e < factor.size(); ++e) {
    const auto& t = organ.surface.triangles[e];
    const Eigen::Vector3d& first = organ.surface.vertices[t[0]];
    const Eigen::Vector3d normal =
        (organ.surface.vertices[t[1]] - first).cross(organ.surface.vertices[t[2]] - first).normalized();
    const Eigen::Vector3d mean = axis[t[0]] + axis[t[1]] + axis[t[2]];
    const Eigen::Vector3d along = (mean - mean.dot(normal) * normal).normalized(), across = normal.cross(along);
    const Eigen::Vector3d with = math::cos(scene.angle) * along, beside = math::sin(scene.angle) * across;
    fibres.modulus.push_back(scene.modulus * factor[e]);
    fibres.direction.push_back({with + beside, with - beside});
  }
  return fibres;
}

}  // namespace vibe
