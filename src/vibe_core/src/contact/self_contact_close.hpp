#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

/// Says which vertices of a surface are so near along it that they belong to the same wall.
class SurfaceWalls {
 public:
  /// @param reach  distance along edges within which the surface is one wall; vertices within two edges always are [m]
  SurfaceWalls(const SurfaceMesh& rest, double reach);

  bool oneWall(int vertex, int other) const {
    return std::binary_search(wall_.begin() + start_[vertex], wall_.begin() + start_[vertex + 1], other);
  }

 private:
  std::vector<int> start_, wall_;  // vertices of the same wall, ascending
};

/// The triangles at each vertex of a surface.
class VertexTriangles {
 public:
  VertexTriangles(const std::vector<std::array<int, 3>>& triangles, std::size_t vertices)
      : start_(vertices + 1, 0), triangle_(3 * triangles.size()) {
    for (const auto& t : triangles)
      for (const int v : t) ++start_[v + 1];
    for (std::size_t i = 0; i < vertices; ++i) start_[i + 1] += start_[i];
    std::vector<int> next(start_.begin(), start_.end() - 1);
    for (std::size_t t = 0; t < triangles.size(); ++t)
      for (const int v : triangles[t]) triangle_[next[v]++] = static_cast<int>(t);
  }

  std::size_t vertexCount() const { return start_.size() - 1; }
  /// The first one at a vertex, which must have some.
  int first(int vertex) const { return triangle_[start_[vertex]]; }
  /// Calls visit(triangle) for each triangle at a vertex, ascending.
  template <typename Visit>
  void visit(int vertex, Visit visit) const {
    for (int i = start_[vertex]; i < start_[vertex + 1]; ++i) visit(triangle_[i]);
  }

 private:
  std::vector<int> start_, triangle_;
};

/// Two points of a surface that are nearest to each other: a vertex and a point of a triangle, or points of two edges.
struct ClosePoints {
  std::array<int, 4> node;       ///< ascending within each of the two parts; -1: fewer
  int split;                     ///< number of nodes of the first part: 1: vertex and triangle, 2: two edges
  std::array<double, 4> weight;  ///< of their difference `away` = sum of weight * position; sum 0 [1]
  Eigen::Vector3d away;          ///< from the second to the first [m]
  double share;                  ///< 1; of edges: square of the sine of the angle between them [1]
  bool in_wall;                  ///< on one wall, which is folded there
};

/// Finds the places at which two walls, or parts of a folded one, are nearer than a distance, which are those that may
/// have to be kept apart (SelfContactPaths). A place is a local minimum of the distance: a vertex over the inside of a
/// triangle, or over an edge or a vertex that is its nearest point of all triangles there, or two edges that cross.
class SelfContactClose {
 public:
  using Pair = std::array<int, 2>;  ///< two triangles

  /// All outlive this.
  SelfContactClose(const std::vector<std::array<int, 3>>& triangles, const VertexTriangles& rings,
                   const SurfaceWalls& walls)
      : triangles_(triangles), rings_(rings), walls_(walls) {}

  /// @param pairs     triangles that may be nearer than the distance
  /// @param at        positions [m]
  /// @param distance  [m]
  /// @returns each place once, ascending by node
  const std::vector<ClosePoints>& find(const std::vector<Pair>& pairs, const std::array<std::vector<double>, 3>& at,
                                       double distance);

 private:
  Eigen::Vector3d at(int node) const;
  bool apart(const Pair& pair) const;
  void addVertices(int of, int triangle);
  void addEdges(int one, int other);
  void addEdgePair(std::array<int, 2> one, std::array<int, 2> other);
  bool isInWall(const ClosePoints& place) const;
  bool isNearest(const ClosePoints& place) const;

  const std::vector<std::array<int, 3>>& triangles_;
  const VertexTriangles& rings_;
  const SurfaceWalls& walls_;
  const std::array<std::vector<double>, 3>* at_ = nullptr;
  double distance_ = 0;
  std::vector<ClosePoints> places_;
};

}  // namespace vibe
