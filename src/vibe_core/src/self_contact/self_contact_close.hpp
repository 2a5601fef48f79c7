#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

class ThreadPool;

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
  struct Facing {
    int vertex, triangle;
  };

  /// All outlive this.
  SelfContactClose(const std::vector<std::array<int, 3>>& triangles, const VertexTriangles& rings,
                   const SurfaceWalls& walls);

  /// @param facing    the triangles around the vertex may be nearer to the triangle than the distance; ascending by
  ///                  vertex
  /// @param at        positions [m]
  /// @param distance  [m]
  /// @param pool      null: the calling thread only; the places are the same
  /// @returns each place once, ascending by node
  const std::vector<ClosePoints>& find(const std::vector<Facing>& facing, const std::array<std::vector<double>, 3>& at,
                                       double distance, ThreadPool* pool = nullptr);

 private:
  using Edge = std::array<int, 2>;  // nodes, ascending

  class Marks;
  /// Around one triangle after the other.
  struct Scan {
    Marks& marks;                      // of what the triangle has met
    std::vector<ClosePoints>& places;  // to which it adds
    Eigen::Vector3d low, high;         // corners of the box around the triangle and the distance [m]
  };

  void listEdges();
  void listFacing(const std::vector<Facing>& facing);
  void collect(ThreadPool* pool);
  void findAmong(int first, int last, std::vector<ClosePoints>& places) const;
  void findAt(int triangle, Scan& scan) const;
  void meet(int triangle, int other, Scan& scan) const;
  Eigen::Vector3d at(int node) const { return {(*at_)[0][node], (*at_)[1][node], (*at_)[2][node]}; }
  template <std::size_t Count>
  bool isFar(const std::array<int, Count>& nodes, const Scan& scan) const;
  void addVertices(int triangle, int other, Scan& scan) const;
  void addEdges(int triangle, int other, Scan& scan) const;
  void addEdgePair(const Edge& one, const Edge& other, Scan& scan) const;
  bool isInWall(const ClosePoints& place) const;
  bool isNearest(const ClosePoints& place) const;

  const std::vector<std::array<int, 3>>& triangles_;
  const VertexTriangles& rings_;
  const SurfaceWalls& walls_;
  std::vector<Edge> edges_;                       // ascending
  std::vector<std::array<int, 3>> edge_of_;       // of each triangle's nodes 0 and 1, 1 and 2, 2 and 0
  std::vector<int> of_vertex_, facing_triangle_;  // what each vertex faces: start, triangles
  std::vector<int> of_triangle_, facing_vertex_;  // what faces each triangle
  const std::array<std::vector<double>, 3>* at_ = nullptr;
  double distance_ = 0;
  std::vector<ClosePoints> places_;
  std::vector<std::vector<ClosePoints>> found_;  // by piece, where several threads look
};

}  // namespace vibe
