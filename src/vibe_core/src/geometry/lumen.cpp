#include "geometry/lumen.hpp"

#include <Eigen/Geometry>

namespace vibe {

namespace {
// relative to the first vertex: this does not change the sums over a closed surface and reduces round-off
Eigen::Vector3d corner(const std::vector<double>& x, const std::vector<double>& y, const std::vector<double>& z,
                       int i) {
  return {x[i] - x[0], y[i] - y[0], z[i] - z[0]};
}
}  // namespace

double lumenVolume(const SurfaceMesh& surface, const std::vector<double>& x, const std::vector<double>& y,
                   const std::vector<double>& z) {
  double six_volumes = 0;
  for (const auto& t : surface.triangles)
    six_volumes += corner(x, y, z, t[0]).dot(corner(x, y, z, t[1]).cross(corner(x, y, z, t[2])));
  return six_volumes / 6;
}

}  // namespace vibe
