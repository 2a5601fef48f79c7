#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "contact/surface_walls.hpp"
#include "contact/vertex_triangles.hpp"

namespace vibe {

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
