#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <vector>

#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

/// Boxes and directions of the triangles of a moving surface in a binary tree. Its topology is that of the rest shape;
/// enclose() adapts it to positions. It finds pairs of triangles without visiting smooth parts of the surface: parts
/// whose normals agree neither face each other nor cross (Volino, Magnenat-Thalmann 1994, "Efficient self-collision
/// detection on smoothly discretized surface animations using geometrical shape regularity"), for moving triangles with
/// the bounds of Tang, Curtis, Yoon, Manocha 2009, "ICCD: Interactive continuous collision detection between deformable
/// models using connectivity-based culling", section 4.
class SelfContactTree {
 public:
  explicit SelfContactTree(const SurfaceMesh& rest);

  struct Box {
    Eigen::Vector3d low = Eigen::Vector3d::Zero(), high = Eigen::Vector3d::Zero();
  };
  /// Of unit normals.
  struct Directions {
    Eigen::Vector3f low = Eigen::Vector3f::Zero(), high = Eigen::Vector3f::Zero();  ///< per component
    float turn = 0;  ///< largest distance of a normal to one within these limits
  };

  /// Adapts the tree to straight paths from `start` to `end`, which may be the same.
  /// @param margin  all boxes grow by it to each side [m]
  /// @param slack   nodes may be so far from these paths [m]
  /// @param rings   whether the directions of a triangle include those of all triangles at its corners
  void enclose(const std::vector<Eigen::Vector3d>& start, const std::vector<Eigen::Vector3d>& end, double margin,
               double slack, bool rings);

  /// Calls visit(a, b), a < b, for pairs of triangles whose boxes overlap and whose normals (or those of triangles at
  /// their corners, see enclose()) may have a cosine below `cosine`.
  template <class Visit>
  void visitFacing(float cosine, Visit visit) const {
    traverse(
        [this, cosine](int a, int b) { return smallestCosine(nodes_[a].directions, nodes_[b].directions) >= cosine; },
        visit);
  }
  /// Calls visit(a, b), a < b, for pairs of triangles whose boxes overlap, except where both belong to a small
  /// connected part of the surface that has no overhang in some direction at any time.
  template <class Visit>
  void visitCrossing(Visit visit) const {
    traverse([this](int a, int b) { return isGraph(a, b); }, visit);
  }

 private:
  struct Node {
    Box box;
    Directions directions;
    int first, count;            // triangles in order_
    int right;                   // the left child follows its parent; 0: leaf
    int first_vertex, vertices;  // in vertex_; none: too large or not connected
  };
  static bool apart(const Box& a, const Box& b) {
    return (a.low.array() > b.high.array()).any() || (b.low.array() > a.high.array()).any();
  }
  static float smallestCosine(const Directions& a, const Directions& b);
  bool isGraph(int a, int b) const;
  bool adjacent(const Node& a, const Node& b) const;

  int build(int first, int count, const std::vector<Eigen::Vector3d>& centre);
  void listVertices(Node& node);
  bool isConnected(const Node& node) const;
  void encloseTriangle(int triangle, const std::vector<Eigen::Vector3d>& start, const std::vector<Eigen::Vector3d>& end,
                       double margin, double slack);
  void spreadOverRings();

  template <class Skip, class Visit>
  void traverse(const Skip& skip, Visit& visit) const {
    stack_.assign(1, {0, 0});
    while (!stack_.empty()) {
      const auto [a, b] = stack_.back();
      stack_.pop_back();
      if ((a != b && apart(nodes_[a].box, nodes_[b].box)) || skip(a, b)) continue;
      const bool leaf_a = nodes_[a].right == 0, leaf_b = nodes_[b].right == 0;
      if (leaf_a && leaf_b) {
        visitLeaves(nodes_[a], nodes_[b], a == b, visit);
      } else if (a == b) {
        stack_.push_back({a + 1, nodes_[a].right});
        stack_.push_back({nodes_[a].right, nodes_[a].right});
        stack_.push_back({a + 1, a + 1});
      } else if (leaf_b || (!leaf_a && nodes_[a].count >= nodes_[b].count)) {
        stack_.push_back({nodes_[a].right, b});
        stack_.push_back({a + 1, b});
      } else {
        stack_.push_back({a, nodes_[b].right});
        stack_.push_back({a, b + 1});
      }
    }
  }
  template <class Visit>
  void visitLeaves(const Node& a, const Node& b, bool same, Visit& visit) const {
    for (int i = 0; i < a.count; ++i)
      for (int j = same ? i + 1 : 0; j < b.count; ++j) {
        const int one = order_[a.first + i], other = order_[b.first + j];
        if (!apart(box_[one], box_[other])) visit(std::min(one, other), std::max(one, other));
      }
  }

  std::vector<std::array<int, 3>> triangles_;
  std::vector<Node> nodes_;                               // parents before children
  std::vector<int> order_;                                // triangles
  std::vector<int> vertex_;                               // ascending, of the nodes that have a list
  std::vector<Box> box_;                                  // per triangle
  std::vector<Directions> directions_, ring_directions_;  // per triangle, per vertex
  mutable std::vector<std::array<int, 2>> stack_;
};

}  // namespace vibe
