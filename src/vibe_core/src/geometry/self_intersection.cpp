#include "vibe_core/geometry/triangle_tree.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>

namespace vibe {

namespace {

using Triangle = std::array<int, 3>;

/// Six times the signed volume of a tetrahedron.
double orientation(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                   const Eigen::Vector3d& d) {
  return (b - a).cross(c - a).dot(d - a);
}

bool has(const Triangle& t, int v) {
  return t[0] == v || t[1] == v || t[2] == v;
}

/// Whether the open segment p, q passes through the inside of the triangle.
bool pierces(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
             const Eigen::Vector3d& c) {
  const double side_p = orientation(a, b, c, p), side_q = orientation(a, b, c, q);
  if (side_p * side_q >= 0.0) return false;
  const double ab = orientation(p, q, a, b), bc = orientation(p, q, b, c), ca = orientation(p, q, c, a);
  return (ab > 0.0 && bc > 0.0 && ca > 0.0) || (ab < 0.0 && bc < 0.0 && ca < 0.0);
}

/// Whether an edge of `first` pierces `second`. Edges that start at a shared vertex can only touch it there.
bool edgesPierce(const SurfaceMesh& mesh, const Triangle& first, const Triangle& second) {
  for (int k = 0; k < 3; ++k) {
    const int p = first[k], q = first[(k + 1) % 3];
    if (has(second, p) || has(second, q)) continue;
    if (pierces(mesh.vertices[p], mesh.vertices[q], mesh.vertices[second[0]], mesh.vertices[second[1]],
                mesh.vertices[second[2]])) {
      return true;
    }
  }
  return false;
}

}  // namespace

std::pair<int, int> findSelfIntersection(const TriangleTree& tree) {
  const SurfaceMesh& mesh = tree.mesh();
  std::pair<int, int> found(-1, -1);
  tree.overlappingPairs([&](int a, int b) {
    const Triangle &first = mesh.triangles[a], &second = mesh.triangles[b];
    const auto shared = std::count_if(first.begin(), first.end(), [&](int v) { return has(second, v); });
    if (shared >= 2) return true;  // neighbours at an edge meet only there, unless folded flat
    if (!edgesPierce(mesh, first, second) && !edgesPierce(mesh, second, first)) return true;
    found = {a, b};
    return false;
  });
  return found;
}

}  // namespace vibe
