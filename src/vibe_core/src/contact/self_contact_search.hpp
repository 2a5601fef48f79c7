#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

/// Finds parts of a surface that are near in space but not along it, with a uniform grid of cells over the vertices.
class SelfContactSearch {
 public:
  struct Near {
    int vertex, triangle;
  };

  /// @param one_wall  per vertex, distance along edges within which the surface counts as the same wall [m]
  SelfContactSearch(const SurfaceMesh& rest, const std::vector<double>& one_wall);

  /// The vertices and triangles of different walls that are nearer to each other than the distance plus half the
  /// longest edge at the vertex, ascending. If there are none, no two edges of different walls are nearer than the
  /// distance either. [m]
  void findNear(const std::vector<Eigen::Vector3d>& positions, double distance, std::vector<Near>& found);
  /// Longest edge of the triangles at a vertex at the last findNear() [m].
  double longestEdge(int vertex) const { return edge_[vertex]; }

  bool oneWall(int vertex, int other) const;
  bool sameWall(const std::array<int, 3>& one, const std::array<int, 3>& other) const;
  /// Calls visit(triangle) for each triangle at a vertex.
  template <typename Visit>
  void visitRing(int vertex, Visit visit) const {
    for (int i = triangle_start_[vertex]; i < triangle_start_[vertex + 1]; ++i) visit(triangle_of_[i]);
  }

 private:
  void joinWalls(const SurfaceMesh& rest, const std::vector<double>& one_wall);
  void measureEdges(const std::vector<Eigen::Vector3d>& positions);
  void layGrid(const std::vector<Eigen::Vector3d>& positions, double distance);
  void fillCells(const std::vector<Eigen::Vector3d>& positions);
  std::array<int, 3> cellOf(const Eigen::Vector3d& p) const;
  void findNearOf(int vertex, const std::vector<Eigen::Vector3d>& positions, double distance, std::vector<Near>& found);
  void visitCell(int cell, int vertex, const std::vector<Eigen::Vector3d>& positions, double distance);

  std::vector<std::array<int, 3>> triangles_;
  std::vector<int> triangle_start_, triangle_of_;  // triangles of each vertex
  std::vector<int> wall_start_, wall_;             // vertices of the same wall, ascending
  std::vector<double> edge_;                       // per vertex, longest of its triangles [m]
  double longest_edge_ = 0;
  Eigen::Vector3d corner_ = Eigen::Vector3d::Zero();
  double cell_ = 1;  // size of a cell [m]
  std::array<int, 3> cells_ = {1, 1, 1};
  std::vector<int> cell_of_;     // per vertex, its cell number
  std::vector<int> cell_start_;  // (cells + 1)
  std::vector<int> sorted_;      // vertices by cell, ascending within one
  std::vector<int> next_;        // per cell, while sorting
  std::vector<int> wall_stamp_, triangle_stamp_;
  int stamp_ = 0;
  std::vector<int> candidates_;  // triangles of one vertex
};

}  // namespace vibe
