#pragma once

#include <Eigen/Core>
#include <array>
#include <utility>
#include <vector>

#include "contact/self_contact_search.hpp"

namespace vibe {

/// Straight paths of the nodes of a surface, shortened so that no part of the surface passes through another wall.
class SelfContactPaths {
 public:
  /// @param floor  minimum distance of walls [m]
  SelfContactPaths(const std::vector<std::array<int, 3>>& triangles, const SelfContactSearch& search, double floor);

  /// A vertex and a triangle that may come near each other, and the vector from the triangle to the vertex at the
  /// start.
  struct Approach {
    SelfContactSearch::Near near;
    Eigen::Vector3d away;
  };

  /// @param approaches  all pairs of different walls that are nearer than the sum of twice the longest move, the floor
  ///         and half the longest edge at the vertex
  /// @param move        in and out [m]
  /// @returns whether any was shortened
  bool shorten(const std::vector<Eigen::Vector3d>& start, const std::vector<Approach>& approaches,
               std::vector<Eigen::Vector3d>& move);

 private:
  struct Primitive {
    std::array<int, 4> node;
    int split;  // number of nodes in the first part: 1: vertex and triangle, 2: two edges
  };
  void collect(const std::vector<Approach>& approaches);
  bool isNews(int triangle) const;
  bool shortenPair(int one, int other, bool stop);
  bool shortenPrimitive(const Primitive& primitive, bool stop);
  double freePart(const Primitive& primitive) const;

  const std::vector<std::array<int, 3>>& triangles_;
  const SelfContactSearch& search_;
  double floor_;
  const std::vector<Eigen::Vector3d>* start_ = nullptr;
  std::vector<Eigen::Vector3d>* move_ = nullptr;
  std::vector<char> news_, next_news_;      // per node: its move was shortened in the last round, in this one
  std::vector<std::pair<int, int>> pairs_;  // of triangles that may meet, ascending
};

}  // namespace vibe
