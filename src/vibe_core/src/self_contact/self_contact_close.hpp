#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "self_contact/surface_walls.hpp"

namespace vibe {

class ThreadPool;

/// Two points of a surface that are nearest to each other: a vertex and a point of a triangle, or points of two edges.
struct ClosePoints {
  std::array<int, 4> node;       ///< ascending within each of the two parts; -1: fewer
  int split;                     ///< number of nodes of the first part: 1: vertex and triangle, 2: two edges
  std::array<double, 4> weight;  ///< of their difference `away` = sum of weight * position; sum 0
  Eigen::Vector3d away;          ///< from the second to the first [m]
  double share;                  ///< 1; of edges: square of the sine of the angle between them
  bool in_wall;                  ///< on one wall, which is folded there
};

/// Finds the spots at which two walls, or parts of a folded one, are nearer than a distance, which are those that may
/// have to be kept separate (SelfContactPaths). A spot is a local minimum of the distance: a vertex over the inside of
/// a triangle, or over an edge or a vertex that is its nearest point of all triangles there, or two edges that cross.
/// For edges from x along u and from y along v, with r = x - y, the nearest points x + s u and y + t v have
///   s = ((u.v) (v.r) - (u.r) (v.v)) / D,  t = ((u.u) (v.r) - (u.v) (u.r)) / D,  D = (u.u) (v.v) - (u.v)^2
/// (Ericson 2005, "Real-Time Collision Detection", section 5.1.9); D / ((u.u) (v.v)) is the square of the sine between
/// them, the share of the spot.
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
  /// @param pool      null: the calling thread only; the spots are the same
  /// @returns each spot once, ascending by node
  const std::vector<ClosePoints>& find(const std::vector<Facing>& facing, const std::array<std::vector<double>, 3>& at,
                                       double distance, ThreadPool* pool = nullptr);

 private:
  using Edge = std::array<int, 2>;  // nodes, ascending

  class Marks;
  /// What a thread looks at and finds, one triangle after the other.
  struct Scan {
    Marks& marks;                     // of what the triangle has met
    std::vector<ClosePoints>& spots;  // to which it adds
    Eigen::Vector3d low, high;        // corners of the box around the triangle and the distance [m]
  };

  void listEdges();
  void listFacing(const std::vector<Facing>& facing);
  void collect(ThreadPool* pool);
  void findAmong(int first, int last, std::vector<ClosePoints>& spots) const;
  void findAt(int triangle, Scan& scan) const;
  void meet(int triangle, int other, Scan& scan) const;
  Eigen::Vector3d at(int node) const { return {(*at_)[0][node], (*at_)[1][node], (*at_)[2][node]}; }
  template <std::size_t Count>
  bool isFar(const std::array<int, Count>& nodes, const Scan& scan) const;
  void addVertices(int triangle, int other, Scan& scan) const;
  void addEdges(int triangle, int other, Scan& scan) const;
  void addEdgePair(const Edge& one, const Edge& other, Scan& scan) const;
  bool isInWall(const ClosePoints& spot) const;
  bool isNearest(const ClosePoints& spot) const;

  const std::vector<std::array<int, 3>>& triangles_;
  const VertexTriangles& rings_;
  const SurfaceWalls& walls_;
  std::vector<Edge> edges_;                       // ascending
  std::vector<std::array<int, 3>> edge_of_;       // of each triangle's nodes 0 and 1, 1 and 2, 2 and 0
  std::vector<int> of_vertex_, facing_triangle_;  // what each vertex faces: start, triangles
  std::vector<int> of_triangle_, facing_vertex_;  // what faces each triangle
  const std::array<std::vector<double>, 3>* at_ = nullptr;
  double distance_ = 0;
  std::vector<ClosePoints> spots_;
  std::vector<std::vector<ClosePoints>> found_;  // by piece, where several threads look
};

}  // namespace vibe
