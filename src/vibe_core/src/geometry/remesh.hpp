#pragma once

#include <array>
#include <functional>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "vibe_core/geometry/surface_mesh.hpp"
#include "vibe_core/program/progress.hpp"

namespace vibe {

/// A closed, oriented triangle surface with edge split, collapse and flip. Every operation keeps the surface closed,
/// oriented and manifold, or is rejected. Vertices keep their numbers until toMesh().
class EditableMesh {
 public:
  using Edge = std::pair<int, int>;  ///< vertex numbers, the smaller first

  /// @param mesh closed, oriented and manifold (see checkSurface()).
  explicit EditableMesh(const SurfaceMesh& mesh);

  int vertexCount() const { return alive_count_; }
  int vertexEnd() const { return static_cast<int>(positions_.size()); }  ///< one past the largest vertex number
  bool alive(int vertex) const { return !around_[vertex].empty(); }
  int valence(int vertex) const { return static_cast<int>(around_[vertex].size()); }
  const Eigen::Vector3d& position(int vertex) const { return positions_[vertex]; }
  void move(int vertex, const Eigen::Vector3d& position) { positions_[vertex] = position; }
  const std::vector<int>& trianglesAround(int vertex) const { return around_[vertex]; }
  const std::array<int, 3>& triangle(int number) const { return triangles_[number]; }

  std::vector<Edge> edges() const;  ///< all, ascending
  bool isEdge(int a, int b) const;
  double length(const Edge& edge) const { return (positions_[edge.first] - positions_[edge.second]).norm(); }

  /// Vertices opposite the edge: on its left and on its right, seen from outside along a -> b.
  std::array<int, 2> wings(int a, int b) const;

  /// Twice the area of the triangle, along its outward normal.
  Eigen::Vector3d areaVector(int triangle) const;

  /// Inserts a new vertex on the edge and returns its number.
  int split(int a, int b, const Eigen::Vector3d& position);

  /// Merges b into a at `position`. Returns false if the surface would not stay manifold or, with `gently`, if a
  /// triangle would flip over, a valence would leave 4..9 or an edge would become longer than `longest`.
  bool collapse(int a, int b, const Eigen::Vector3d& position, bool gently, double longest);

  /// Flips the edge in its quadrilateral. Returns false if the flipped edge exists already, a valence would fall below
  /// 4, or the two new triangles would fold.
  bool flip(int a, int b);

  SurfaceMesh toMesh() const;  ///< with consecutive vertex numbers

 private:
  std::array<int, 2> trianglesOf(int a, int b) const;  ///< left and right of a -> b
  bool mayCollapse(int a, int b, const Eigen::Vector3d& position, double longest) const;
  bool staysUpright(int moved, int other, const Eigen::Vector3d& position, double longest) const;
  void replaceVertex(int triangle, int from, int to);
  void addTriangle(int a, int b, int c);
  void removeFrom(int vertex, int triangle);

  std::vector<Eigen::Vector3d> positions_;
  std::vector<std::array<int, 3>> triangles_;  ///< a removed triangle has vertex -1
  std::vector<std::vector<int>> around_;       ///< triangles of each vertex; empty: removed
  int alive_count_ = 0;
};

/// Returns the nearest point of the surface onto which a remeshed surface is projected.
using Projection = std::function<Eigen::Vector3d(const Eigen::Vector3d&)>;

/// Covers a closed surface evenly with exactly `vertices` vertices: isotropic remeshing by splits, collapses, flips
/// and tangential relaxation (Botsch and Kobbelt, A remeshing approach to multiresolution modeling, 2004), then
/// single splits or collapses until the number is met. Deterministic.
/// @param input    closed, oriented, manifold and near the surface (see checkSurface())
/// @param vertices at least 12
/// @param project  the surface itself; must be continuous near the input
/// @throws Error if so few vertices cannot carry the shape.
SurfaceMesh remesh(const SurfaceMesh& input, int vertices, const Projection& project, const Progress& progress = {});

/// Deviation of a remeshed surface from its input.
struct RemeshReport {
  double mean_distance = 0;  ///< from the new vertices to the input [m]
  double max_distance = 0;   ///< [m]
  double volume_error = 0;   ///< (new - old) / old
  bool smoothed = false;     ///< the input was coarser than the result, and its creases were smoothed
};

/// Calls remesh() on the triangles of the input, preserving its volume. Where the input is coarser than the result, its
/// creases are smoothed (Taubin, A signal processing approach to fair surface design, 1995).
SurfaceMesh remeshSurface(const SurfaceMesh& input, int vertices, RemeshReport* report = nullptr,
                          const Progress& progress = {});

}  // namespace vibe
