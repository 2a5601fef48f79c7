#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "contact/self_contact_tree.hpp"
#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

/// Finds parts of a surface that are near in space but not along it.
class SelfContactSearch {
 public:
  struct Near {
    int vertex, triangle;
    bool operator<(const Near& other) const {
      return vertex < other.vertex || (vertex == other.vertex && triangle < other.triangle);
    }
  };

  /// @param one_wall  per vertex, distance along edges within which the surface counts as the same wall [m]
  SelfContactSearch(const SurfaceMesh& rest, const std::vector<double>& one_wall);

  /// The vertices and triangles of different walls that face each other and are nearer than a distance, ascending, with
  /// all that may be so after no node has moved by more than a slack. Facing: the cosine between the normals of the
  /// triangle and of a triangle at the vertex is below `cosine`. [m]
  void findNear(const std::vector<Eigen::Vector3d>& positions, double distance, double slack, float cosine,
                std::vector<Near>& found);
  /// The pairs of triangles without a common edge that may come nearer than a floor on straight paths, ascending. Small
  /// parts without overhang do not come near themselves. [m]
  /// @param slack  nodes may be so far from these paths [m]
  void findMeetings(const std::vector<Eigen::Vector3d>& start, const std::vector<Eigen::Vector3d>& end, double floor,
                    double slack, std::vector<std::array<int, 2>>& found);

  bool oneWall(int vertex, int other) const;
  /// Calls visit(triangle) for each triangle at a vertex.
  template <typename Visit>
  void visitRing(int vertex, Visit visit) const {
    for (int i = triangle_start_[vertex]; i < triangle_start_[vertex + 1]; ++i) visit(triangle_of_[i]);
  }

 private:
  void joinWalls(const SurfaceMesh& rest, const std::vector<double>& one_wall);
  void addNear(int owner, int triangle, const std::vector<Eigen::Vector3d>& positions, double distance,
               std::vector<Near>& found) const;

  bool apart(int one, int other, const std::vector<Eigen::Vector3d>& start, const std::vector<Eigen::Vector3d>& end,
             double distance) const;

  std::vector<std::array<int, 3>> triangles_;
  SelfContactTree tree_;
  std::vector<int> triangle_start_, triangle_of_;  // triangles of each vertex
  std::vector<int> wall_start_, wall_;             // vertices of the same wall, ascending
};

}  // namespace vibe
