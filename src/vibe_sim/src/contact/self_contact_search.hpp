#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <vector>

#include "vibe_sim/geometry/surface_mesh.hpp"

namespace vibe {

/// Parts of a surface that are near in space but not along it, by a uniform grid of cells over the vertices.
/// Cells, and vertices in a cell, come in a fixed order.
class SelfContactSearch {
 public:
  static constexpr double kWatchedCosine = 0.8;  ///< of normals: well before walls face each other, they are watched

  /// @param one_wall  per vertex, distance along edges within which the surface is one wall with it [m]
  SelfContactSearch(const SurfaceMesh& rest, const std::vector<double>& one_wall);

  /// Takes positions and their normals.
  void place(const std::vector<Eigen::Vector3d>& positions);
  /// Once after place(): flags the vertices that another wall may be nearer to than this, with a normal beyond the
  /// watched cosine. [m]
  void flagNear(double distance);
  bool anyFlagged() const { return any_flagged_; }
  bool flagged(int vertex) const { return flagged_[vertex] != 0; }

  /// Calls visit(triangle) once for each triangle of another wall that may be nearer to a flagged vertex than the
  /// distance of flagNear.
  template <typename Visit>
  void visitNear(int vertex, Visit visit);

  const Eigen::Vector3d& normal(int vertex) const { return normal_[vertex]; }
  /// Normal of a triangle with the length of twice its area [m^2].
  const Eigen::Vector3d& areaVector(int triangle) const { return area_vector_[triangle]; }
  double lowestHeight() const { return lowest_height_; }  ///< of any triangle [m]
  bool oneWall(int vertex, int other) const;

 private:
  struct Cell {
    std::array<int, 3> at;
    int first, last;            // range of sorted_
    Eigen::Vector3f low, high;  // box of the normals
  };
  void joinWalls(const SurfaceMesh& rest, const std::vector<double>& one_wall);
  void layGrid(double distance);
  void fillCells();
  void comparePair(const Cell& one, const Cell& other);
  int cellNumber(const Eigen::Vector3d& p, std::array<int, 3>& at) const;

  std::vector<std::array<int, 3>> triangles_;
  std::vector<int> triangle_start_, triangle_of_;  // triangles of each vertex
  std::vector<int> wall_start_, wall_;             // vertices of the same wall, ascending
  std::vector<Eigen::Vector3d> position_, area_vector_, normal_;
  double longest_edge_ = 0, lowest_height_ = 0;
  Eigen::Vector3d corner_;
  std::vector<double> near_;  // per vertex, how near one of its triangles makes it matter [m]
  double cell_ = 1;           // size of a cell [m]
  std::array<int, 3> cells_ = {1, 1, 1};
  std::vector<int> cell_of_;     // per vertex, its cell number
  std::vector<int> cell_start_;  // (cells + 1)
  std::vector<int> sorted_;      // vertices by cell
  std::vector<int> occupied_;    // per cell number, index into filled_, -1: empty
  std::vector<Cell> filled_;
  std::vector<char> flagged_;
  bool any_flagged_ = false;
  std::vector<int> vertex_stamp_, triangle_stamp_;
  int stamp_ = 0;
};

template <typename Visit>
void SelfContactSearch::visitNear(int vertex, Visit visit) {
  ++stamp_;
  for (int k = wall_start_[vertex]; k < wall_start_[vertex + 1]; ++k) vertex_stamp_[wall_[k]] = stamp_;
  const Cell& home = filled_[occupied_[cell_of_[vertex]]];
  for (int z = std::max(home.at[2] - 1, 0); z <= std::min(home.at[2] + 1, cells_[2] - 1); ++z)
    for (int y = std::max(home.at[1] - 1, 0); y <= std::min(home.at[1] + 1, cells_[1] - 1); ++y)
      for (int x = std::max(home.at[0] - 1, 0); x <= std::min(home.at[0] + 1, cells_[0] - 1); ++x) {
        const int cell = (z * cells_[1] + y) * cells_[0] + x;
        for (int k = cell_start_[cell]; k < cell_start_[cell + 1]; ++k) {
          const int other = sorted_[k];
          const double near = near_[other];
          if (flagged_[other] == 0 || (position_[other] - position_[vertex]).squaredNorm() > near * near) continue;
          for (int i = triangle_start_[other]; i < triangle_start_[other + 1]; ++i) {
            const int t = triangle_of_[i];
            if (triangle_stamp_[t] == stamp_) continue;
            triangle_stamp_[t] = stamp_;
            const auto& n = triangles_[t];
            if (vertex_stamp_[n[0]] == stamp_ || vertex_stamp_[n[1]] == stamp_ || vertex_stamp_[n[2]] == stamp_)
              continue;
            visit(t);
          }
        }
      }
}

}  // namespace vibe
