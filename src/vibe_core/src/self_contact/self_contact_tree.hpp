#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "self_contact/self_contact_bounds.hpp"
#include "self_contact/self_contact_close.hpp"
#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

/// Boxes around the triangles and cones around the normals of a moving surface in a binary tree. Its topology is that
/// of the rest shape; adapt() renews what has changed. It finds pairs of triangles without visiting smooth parts of the
/// surface: parts whose normals agree neither face each other nor cross (Volino, Magnenat-Thalmann 1994, "Efficient
/// self-collision detection on smoothly discretized surface animations using geometrical shape regularity"), for moving
/// triangles with the bounds of Tang, Curtis, Yoon, Manocha 2009, "ICCD: Interactive continuous collision detection
/// between deformable models using connectivity-based culling", section 4.
class SelfContactTree {
 public:
  SelfContactTree(const SurfaceMesh& rest, const VertexTriangles& rings);
  /// Says which vertices belong to one wall, which does not face itself.
  void setWalls(const SurfaceWalls& walls);

  /// A box along the axes; fourth components are 0.
  struct Box {
    Eigen::Array4f low = Eigen::Array4f::Zero(), minus_high = Eigen::Array4f::Zero();
  };
  /// A cone around unit normals.
  struct Cone {
    Eigen::Vector4f axis = Eigen::Vector4f::Zero();  ///< unit, fourth component 0
    float cosine = -1, sine = 0;  ///< of the angle from the axis to the side; cosine <= 0: any normals
  };

  /// Per vertex, number of a small part of the surface.
  std::vector<int> parts() const;
  /// Renews boxes and cones where the bounds have changed in their last adapt(); everywhere if `all`.
  void adapt(const SelfContactBounds& bounds, bool all);

  /// Calls visit(v, t) for vertices and triangles that may be nearer than about a distance, where the normals of some
  /// triangle at the vertex and of the other one may have a cosine below `cosine`; seldom for those of one wall. Of
  /// those for which this was so before the last adapt(), only where one hasNewBall() or hasNewBox() now.
  template <class Visit>
  void visitFacing(float cosine, float distance, Visit visit) const {
    const auto one_way = [&](const Node& a, const Node& b) {
      return isOneWall(a, b) || keepsCosine(a.around, b.around, cosine) ? Part::Skip : Part::Changes;
    };
    traverse(kBox | kAround, distance, one_way, [&](int a, int b, bool) {
      const bool all = keepsCosine(nodes_[a].around_before, nodes_[b].around_before, cosine - kCosineSpare);
      visitVertices(a, b, all, distance, visit);
      if (a != b) visitVertices(b, a, all, distance, visit);
    });
  }
  /// Calls visit(a, b), a < b, for pairs of triangles that are nearer than about a distance, except where both belong
  /// to a small connected part of the surface that has no overhang in some direction at any time. Only pairs of which
  /// one hasNewPath(), or that were excepted before the last adapt().
  template <class Visit>
  void visitCrossing(float distance, Visit visit) const {
    const auto graph = [&](const Node& a, const Node& b) {
      if (a.vertices == 0 || b.vertices == 0) return Part::Changes;
      const bool now = isGraph(a.own, b.own);
      if (!now && !isGraph(a.before, b.before)) return Part::Changes;
      if (&a != &b && !adjacent(a, b)) return Part::Changes;
      return now ? Part::Skip : Part::All;
    };
    traverse(kBox | kOwn, distance, graph, [&](int a, int b, bool all) { visitTriangles(a, b, all, distance, visit); });
  }
  /// Whether the last adapt() may have changed the position of a vertex, that of a triangle, or that or the cone of its
  /// normals.
  bool hasNewBall(int vertex) const { return hasNewBox(rings_.first(vertex)); }
  bool hasNewBox(int triangle) const { return (changed_[triangle] & kBox) != 0; }
  bool hasNewPath(int triangle) const { return (changed_[triangle] & (kBox | kOwn)) != 0; }
  /// Calls visit(triangle) for each triangle of which the last adapt() has changed something.
  template <class Visit>
  void visitChanges(Visit visit) const {
    for (const int t : renewed_) visit(t);
  }
  /// Whether the normals of a triangle and those around it differ so much that they tell nothing about what it faces.
  bool isRough(int triangle) const { return around_[triangle].cosine < rough_cosine_; }

 private:
  static constexpr float kPointRounding = 1e-6F;  // above that of positions within metres in single precision [m]
  static constexpr float kCosineSpare = 1e-4F;    // far above rounding in the cones of parts and of their parts
  enum Change : char { kBox = 1, kOwn = 2, kAround = 4, kEverything = 7 };
  enum class Part { Skip, Changes, All };
  struct Limits {
    Box box;
    int right = 0;     // the left child follows its parent; 0: leaf
    char changed = 0;  // Change
  };
  struct Node {
    Cone own, before;            // of the triangles; before the last adapt()
    Cone around, around_before;  // with the triangles at their corners
    int first, count;            // triangles in order_
    int first_vertex, vertices;  // in vertex_; none: too large or not connected
    int first_owned, owned;      // in owned_, of leaves
    int first_same, same;        // in same_wall_
  };
  static bool apart(const Box& a, const Box& b, float distance) {
    return (a.low + b.minus_high).max(b.low + a.minus_high).maxCoeff() > distance;
  }
  /// Whether the cosine between normals of one cone and of the other is never below `cosine` > 0.
  static bool keepsCosine(const Cone& a, const Cone& b, float cosine) {
    // The cosine of the sum of both half angles, and the chord between the axes: the normals' angle is at most the sum
    // of all three, and its cosine is compared without an inverse function.
    const float both = a.cosine * b.cosine - a.sine * b.sine, between2 = (a.axis - b.axis).squaredNorm();
    if (a.cosine <= 0 || b.cosine <= 0 || both <= 0 || between2 >= 2) return false;
    const float sine = a.sine * b.cosine + a.cosine * b.sine, spare = (1 - 0.5F * between2) * both - cosine;
    return spare >= 0 && spare * spare >= between2 * (1 - 0.25F * between2) * sine * sine;
  }
  static void widen(const Cone& part, Cone& cone);
  static Cone join(const Cone& a, const Cone& b);
  bool isGraph(const Cone& a, const Cone& b) const;
  bool adjacent(const Node& a, const Node& b) const;
  /// Whether no vertex of one and triangle of the other belong to different walls; false also where that is not known.
  bool isOneWall(const Node& a, const Node& b) const {
    const int *first = same_wall_.data() + a.first_same, *last = first + a.same;
    return first != last && std::find(first, last, static_cast<int>(&b - nodes_.data())) != last;
  }

  int build(int first, int count, const std::vector<Eigen::Vector3d>& centre);
  void listVertices(Node& node);
  void listOwned(Node& leaf);
  bool isConnected(const Node& node) const;
  void listSameWall(int index, const SurfaceWalls& walls);
  std::vector<int> laterLeavesAround(int leaf) const;
  bool meetsOneWall(const Node& a, const Node& b, const SurfaceWalls& walls) const;
  void forgetChanges();
  void markChanges(const SelfContactBounds& bounds, bool all);
  void mark(int triangle, char change);
  void encloseVertex(int vertex, const SelfContactBounds& bounds);
  void encloseTriangle(int triangle, const SelfContactBounds& bounds);
  void spread(const SelfContactBounds& bounds, bool all);
  void joinChildren();
  void joinTriangles(const Node& leaf, Limits& limits, Cone& own, Cone& around) const;

  template <class Judge, class Visit>
  void traverse(char changes, float distance, const Judge& judge, const Visit& visitLeaves) const {
    // Pairs of nodes with a mark: everything below counts, changed or not. A node is paired with itself first.
    stack_.assign(1, {0, 0, 0});
    while (!stack_.empty()) {
      auto [a, b, all] = stack_.back();
      stack_.pop_back();
      const Limits &one = limits_[a], &other = limits_[b];
      if (all == 0 && ((one.changed | other.changed) & changes) == 0) continue;
      if (a != b && apart(one.box, other.box, distance)) continue;
      // Whole pairs of parts are skipped where nothing below can matter, before boxes are opened.
      const Part part = judge(nodes_[a], nodes_[b]);
      if (part == Part::Skip) continue;
      if (part == Part::All) all = 1;
      if (one.right == 0 && other.right == 0) {
        visitLeaves(a, b, all != 0);
      } else if (a == b) {
        stack_.push_back({a + 1, one.right, all});
        stack_.push_back({one.right, one.right, all});
        stack_.push_back({a + 1, a + 1, all});
        // The larger of two different nodes is opened.
      } else if (other.right == 0 || (one.right != 0 && nodes_[a].count >= nodes_[b].count)) {
        stack_.push_back({one.right, b, all});
        stack_.push_back({a + 1, b, all});
      } else {
        stack_.push_back({a, other.right, all});
        stack_.push_back({a, b + 1, all});
      }
    }
  }
  /// Whether a ball is certainly farther than a distance from all that may be within a box.
  static bool isFar(const Eigen::Array4f& ball, const Box& box, float distance) {
    Eigen::Array4f off = (box.low - ball).max(ball + box.minus_high).max(0);
    off[3] = 0;
    const float most = distance + ball[3] + kPointRounding;
    return (off * off).sum() > most * most;
  }
  /// Visits vertices of one leaf with triangles of another.
  template <class Visit>
  void visitVertices(int a, int b, bool all, float distance, const Visit& visit) const {
    const Node &one = nodes_[a], &other = nodes_[b];
    for (const int *v = owned_.data() + one.first_owned, *end = v + one.owned; v != end; ++v) {
      const Eigen::Array4f& ball = ball_[*v];
      const bool whole = all || hasNewBall(*v);
      if (!(whole || (limits_[b].changed & kBox) != 0) || isFar(ball, limits_[b].box, distance)) continue;
      for (const int *t = &order_[other.first], *last = t + other.count; t != last; ++t)
        if ((whole || hasNewBox(*t)) && !isFar(ball, box_[*t], distance)) visit(*v, *t);
    }
  }
  template <class Visit>
  void visitTriangles(int a, int b, bool all, float distance, const Visit& visit) const {
    const Node &one = nodes_[a], &other = nodes_[b];
    for (int i = 0; i < one.count; ++i) {
      const int t = order_[one.first + i];
      if (a != b && apart(box_[t], limits_[b].box, distance)) continue;
      for (int j = a == b ? i + 1 : 0; j < other.count; ++j) {
        const int u = order_[other.first + j];
        if (!all && !hasNewPath(t) && !hasNewPath(u)) continue;
        if (!apart(box_[t], box_[u], distance)) visit(std::min(t, u), std::max(t, u));
      }
    }
  }

  float rough_cosine_, least_height_;  // the policy's, in single precision
  std::vector<std::array<int, 3>> triangles_;
  const VertexTriangles& rings_;
  std::vector<Limits> limits_;  // of the nodes, parents before children
  std::vector<Node> nodes_;
  std::vector<int> order_;                    // triangles
  std::vector<int> vertex_;                   // ascending, of the nodes that have a list
  std::vector<int> owned_;                    // vertices of each leaf that has their first triangle
  std::vector<int> same_wall_;                // nodes of the same wall: small ones themselves, leaves and later leaves
  std::vector<Box> box_;                      // per triangle
  std::vector<Eigen::Array4f> ball_;          // per vertex: centre, radius
  std::vector<Cone> own_, around_, ring_;     // per triangle, per triangle, per vertex
  std::vector<char> changed_;                 // Change, per triangle
  std::vector<int> leaf_of_, parent_;         // per triangle, per node: node
  std::vector<int> renewed_, renewed_nodes_;  // triangles, nodes with a change
  mutable std::vector<std::array<int, 3>> stack_;
};

}  // namespace vibe
