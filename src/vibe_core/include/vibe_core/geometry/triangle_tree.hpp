#pragma once

#include <functional>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

/// Point of a triangle [a, b, c] nearest to p (Ericson, Real-Time Collision Detection, 5.1.5).
Eigen::Vector3d closestPointOnTriangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                       const Eigen::Vector3d& c);

/// A bounding volume hierarchy (axis-aligned boxes) over the triangles of a surface, for nearest points, rays and
/// overlapping pairs. Keeps a copy of the mesh. Deterministic. Queries are thread-safe.
class TriangleTree {
 public:
  struct Hit {
    Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< on the surface [m]
    int triangle = -1;                                ///< -1 if the surface has none
    double distance = 0;                              ///< from the query to the point [m]
  };

  /// @param mesh  any triangles, not necessarily closed; none is allowed, too
  explicit TriangleTree(SurfaceMesh mesh);

  const SurfaceMesh& mesh() const { return mesh_; }  ///< the copy that the tree keeps, with the same numbers

  /// Nearest point of the surface.
  Hit closest(const Eigen::Vector3d& p) const;

  /// Distance along the unit direction to the first triangle hit beyond `start`; infinity if none is hit [m].
  double firstHit(const Eigen::Vector3d& start, const Eigen::Vector3d& direction) const;

  /// Whether a triangle meets the straight line between two points; one that meets it at `to` does not count.
  bool isBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;

  /// The vertices go to these places. The boxes follow, and keep the triangles that they had: queries stay right, and
  /// become slower the more the surface has changed.
  /// @param x, y, z  (vertices) [m]
  void moveTo(const std::vector<double>& x, const std::vector<double>& y, const std::vector<double>& z);

  /// Calls visit(a, b) with a < b for every pair of triangles whose boxes overlap, in a fixed order,
  /// until visit returns false.
  void overlappingPairs(const std::function<bool(int, int)>& visit) const;

 private:
  struct Node {
    Eigen::AlignedBox3d box;
    int begin = 0;   ///< first entry in order_
    int end = 0;     ///< one past the last
    int left = -1;   ///< child node, -1: leaf
    int right = -1;  ///< child node
  };

  int build(int begin, int end);
  Eigen::AlignedBox3d triangleBox(int triangle) const;
  void closest(int node, const Eigen::Vector3d& p, Hit& best) const;
  bool pairs(int a, int b, const std::function<bool(int, int)>& visit) const;
  bool leafPairs(const Node& a, const Node& b, bool same, const std::function<bool(int, int)>& visit) const;

  SurfaceMesh mesh_;
  std::vector<int> order_;  ///< triangle numbers, leaf by leaf
  std::vector<Node> nodes_;
};

/// First pair of triangles that cross each other; (-1, -1) if there is none. Contact at shared vertices or edges does
/// not count. Coplanar overlap and contact without crossing are not detected.
std::pair<int, int> findSelfIntersection(const TriangleTree& tree);

}  // namespace vibe
