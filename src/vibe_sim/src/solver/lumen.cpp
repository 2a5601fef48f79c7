#include "vibe_sim/solver/lumen.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace vibe {

namespace {
// relative to the first vertex: the sums over a closed surface do not change and round off less
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

void volumeGradient(const SurfaceMesh& surface, const std::vector<double>& x, const std::vector<double>& y,
                    const std::vector<double>& z, double* gx, double* gy, double* gz) {
  for (double* g : {gx, gy, gz}) std::fill(g, g + x.size(), 0.0);
  for (const auto& t : surface.triangles) {
    const Eigen::Vector3d p[3] = {corner(x, y, z, t[0]), corner(x, y, z, t[1]), corner(x, y, z, t[2])};
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d g = p[(k + 1) % 3].cross(p[(k + 2) % 3]) / 6;
      gx[t[k]] += g.x();
      gy[t[k]] += g.y();
      gz[t[k]] += g.z();
    }
  }
}

}  // namespace vibe
