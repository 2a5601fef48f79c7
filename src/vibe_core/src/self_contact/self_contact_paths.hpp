#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "self_contact/self_contact_close.hpp"
#include "vibe_core/solver/step_policy.hpp"

namespace vibe {

/// Straight paths of the nodes of a surface, shortened so that no part of the surface passes through another.
///
/// Triangles that share no edge keep a distance between all their vertices, edges and faces that are not common. Each
/// distance is followed along the paths by conservative advancement (Mirtich 1996; Tang, Kim, Manocha 2009, "C2A:
/// Controlled conservative advancement"). At the part s of the way, with the shortest connection w of two primitives
/// and d = |w|, they stay farther apart than the floor f until
///   s' = s + min over i, j of (w . (p_i - q_j) - f d) / (w . (v_j - u_i)),
/// p_i, q_j   nodes of the one and of the other, where they are at s
/// u_i, v_j   whole moves of these nodes
/// where only pairs that close along w count. A way ends where an advance is below path_least_advance. As all paths are
/// straight and run at the same time, the surface crosses itself at no time between start and end either.
class SelfContactPaths {
 public:
  using Pair = std::array<int, 2>;  ///< two triangles

  /// @param walls  parts of one wall are only kept from touching
  /// @param floor  minimum distance of different walls [m]
  SelfContactPaths(const std::vector<std::array<int, 3>>& triangles, const SurfaceWalls& walls, double floor);

  /// Triangles that cross at the start may pass each other and their neighbours, so that they can come apart.
  /// @param pairs  all that may come nearer than the floor
  /// @param stop   nodes that collide stop in place
  /// @param move   in and out [m]
  /// @returns whether any was shortened
  bool shorten(const std::vector<Eigen::Vector3d>& start, const std::vector<Pair>& pairs, bool stop,
               std::vector<Eigen::Vector3d>& move);

 private:
  struct Primitive {
    std::array<int, 4> node;
    int split;  // number of nodes in the first part: 1: vertex and triangle, 2: two edges
  };
  void collect(const std::vector<Pair>& pairs);
  void dropTangled();
  bool keepsSeparate(int one, int other) const;
  bool separates(const Eigen::Vector3d& direction, int one, int other) const;
  bool crosses(int one, int other) const;
  bool isShortened(int triangle) const;
  bool shortenPair(int one, int other, bool stop);
  bool shortenPrimitive(const Primitive& primitive, bool stop);
  double freePart(const Primitive& primitive) const;
  bool isOneWall(const Primitive& primitive) const;
  Eigen::Vector3d normal(int triangle) const;

  const StepPolicy& policy_;
  const std::vector<std::array<int, 3>>& triangles_;
  const SurfaceWalls& walls_;
  double floor_;
  const std::vector<Eigen::Vector3d>* start_ = nullptr;
  std::vector<Eigen::Vector3d>* move_ = nullptr;
  std::vector<char> shortened_, next_shortened_;  // per node: its move was shortened in the last round, in this one
  std::vector<char> tangled_;  // per node: it belongs to a triangle that crosses another at the start
  std::vector<Pair> pairs_;    // that may meet on their whole paths
};

}  // namespace vibe
