// How boxes and cones follow the surface.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>

#include "self_contact/self_contact_tree.hpp"

namespace vibe {

namespace {

// Rounding of a position in single precision, twice over.
constexpr float kPositionRounding = 2.4e-7F;

using TreeBox = SelfContactTree::Box;

TreeBox joinBoxes(const TreeBox& a, const TreeBox& b) {
  return {a.low.min(b.low), a.minus_high.min(b.minus_high)};
}

}  // namespace

void SelfContactTree::adapt(const SelfContactBounds& bounds, bool all) {
  forgetChanges();
  markChanges(bounds, all);
  for (const int t : renewed_) encloseTriangle(t, bounds);
  spread(bounds, all);
  // Marks go up to the root, and stop where another triangle has been before.
  for (const int t : renewed_)
    for (int n = leaf_of_[t]; n >= 0 && (limits_[n].changed | changed_[t]) != limits_[n].changed; n = parent_[n]) {
      if (limits_[n].changed == 0) renewed_nodes_.push_back(n);
      limits_[n].changed |= changed_[t];
    }
  // Children have higher numbers than their parents: they come first.
  std::sort(renewed_nodes_.begin(), renewed_nodes_.end(), std::greater<int>());
  joinChildren();
}

void SelfContactTree::forgetChanges() {
  for (const int t : renewed_) changed_[t] = 0;
  for (const int n : renewed_nodes_) {
    if ((limits_[n].changed & kOwn) != 0) nodes_[n].before = nodes_[n].own;
    if ((limits_[n].changed & kAround) != 0) nodes_[n].around_before = nodes_[n].around;
    limits_[n].changed = 0;
  }
  renewed_.clear();
  renewed_nodes_.clear();
}

void SelfContactTree::markChanges(const SelfContactBounds& bounds, bool all) {
  if (all) {
    for (std::size_t v = 0; v < ball_.size(); ++v) encloseVertex(static_cast<int>(v), bounds);
    for (std::size_t t = 0; t < triangles_.size(); ++t) mark(static_cast<int>(t), kEverything);
  } else {
    for (const int v : bounds.moved()) {
      encloseVertex(v, bounds);
      rings_.visit(v, [this](int t) { mark(t, kBox); });
    }
    for (const int t : bounds.turned()) mark(t, kOwn);
  }
}

void SelfContactTree::mark(int triangle, char change) {
  if (changed_[triangle] == 0) renewed_.push_back(triangle);
  changed_[triangle] = static_cast<char>(changed_[triangle] | change);
}

void SelfContactTree::encloseVertex(int vertex, const SelfContactBounds& bounds) {
  ball_[vertex].head<3>() = bounds.centre()[vertex].cast<float>().array();
  ball_[vertex][3] = static_cast<float>(bounds.radius(vertex));
}

void SelfContactTree::encloseTriangle(int triangle, const SelfContactBounds& bounds) {
  if ((changed_[triangle] & kBox) != 0) {
    TreeBox& box = box_[triangle];
    for (std::size_t k = 0; k < 3; ++k) {
      Eigen::Array4f centre = ball_[triangles_[triangle][k]], radius = Eigen::Array4f::Zero();
      radius.head<3>() = kPositionRounding * centre.head<3>().abs() + centre[3];
      centre[3] = 0;
      const TreeBox ball{centre - radius, -centre - radius};
      box = k == 0 ? ball : joinBoxes(box, ball);
    }
  }
  // A chord of the unit sphere gives the cosine and the sine of the angle over it.
  if ((changed_[triangle] & kOwn) == 0) return;
  const auto& [normal, turn] = bounds.cone(triangle);
  Cone& own = own_[triangle];
  own = Cone();
  if (turn > 1) return;
  own.axis.head<3>() = normal;
  own.cosine = 1 - 0.5F * turn * turn;
  own.sine = turn * std::sqrt(1 - 0.25F * turn * turn);
}

// Joins the normals of the triangles at the corners of those that have turned.
void SelfContactTree::spread(const SelfContactBounds& bounds, bool all) {
  const auto spreadOver = [this](int v) {
    Cone& ring = ring_[v];
    ring = {Eigen::Vector4f::Zero(), 1, 0};
    rings_.visit(v, [&](int t) { ring.axis += own_[t].axis; });
    ring.axis.normalize();
    rings_.visit(v, [&](int t) {
      widen(own_[t], ring);
      mark(t, kAround);
    });
  };
  // A vertex of several triangles that have turned is joined as often: with the same result.
  if (all) {
    for (std::size_t v = 0; v < ring_.size(); ++v) spreadOver(static_cast<int>(v));
  } else {
    for (const int t : bounds.turned())
      for (const int v : triangles_[t]) spreadOver(v);
  }
  // A triangle faces what any triangle at its corners faces.
  for (const int t : renewed_) {
    if ((changed_[t] & kAround) == 0) continue;
    const auto& n = triangles_[t];
    around_[t] = {(ring_[n[0]].axis + ring_[n[1]].axis + ring_[n[2]].axis).normalized(), 1, 0};
    for (const int v : n) widen(ring_[v], around_[t]);
  }
}

// Widens a cone about its axis until it contains another one: the angle between the axes and the half angle of the
// other add up.
void SelfContactTree::widen(const Cone& part, Cone& cone) {
  const float chord2 = (part.axis - cone.axis).squaredNorm();
  const float cosine = 1 - 0.5F * chord2, sine = std::sqrt(chord2 * std::max(0.0F, 1 - 0.25F * chord2));
  const float side = cosine * part.cosine - sine * part.sine;
  if (!(cosine > 0 && part.cosine > 0 && side > 0)) {
    cone.cosine = -1;
  } else if (side < cone.cosine) {
    cone.cosine = side;
    cone.sine = sine * part.cosine + cosine * part.sine;
  }
}

SelfContactTree::Cone SelfContactTree::join(const Cone& a, const Cone& b) {
  Cone all{(a.axis + b.axis).normalized(), 1, 0};
  widen(a, all);
  widen(b, all);
  return all;
}

// Encloses what is below each node that has changed.
void SelfContactTree::joinChildren() {
  for (const int n : renewed_nodes_) {
    Limits& limits = limits_[n];
    if (limits.right == 0) {
      joinTriangles(nodes_[n], limits, nodes_[n].own, nodes_[n].around);
      continue;
    }
    const Limits &a = limits_[n + 1], &b = limits_[limits.right];
    if ((limits.changed & kBox) != 0) limits.box = joinBoxes(a.box, b.box);
    const Node &one = nodes_[n + 1], &other = nodes_[limits.right];
    if ((limits.changed & kOwn) != 0) nodes_[n].own = join(one.own, other.own);
    if ((limits.changed & kAround) != 0) nodes_[n].around = join(one.around, other.around);
  }
}

void SelfContactTree::joinTriangles(const Node& leaf, Limits& limits, Cone& own, Cone& around) const {
  const int* const first = &order_[leaf.first];
  const int* const last = first + leaf.count;
  if ((limits.changed & kBox) != 0) {
    limits.box = box_[*first];
    for (const int* t = first + 1; t != last; ++t) limits.box = joinBoxes(limits.box, box_[*t]);
  }
  const auto unite = [&](const std::vector<Cone>& cones, Cone& all) {
    all = {Eigen::Vector4f::Zero(), 1, 0};
    for (const int* t = first; t != last; ++t) all.axis += cones[*t].axis;
    all.axis.normalize();
    for (const int* t = first; t != last; ++t) widen(cones[*t], all);
  };
  if ((limits.changed & kOwn) != 0) unite(own_, own);
  if ((limits.changed & kAround) != 0) unite(around_, around);
}

// Whether the normals of two parts have a common direction without overhangs.
bool SelfContactTree::isGraph(const Cone& a, const Cone& b) const {
  return a.cosine > least_height_ && b.cosine > least_height_ && join(a, b).cosine > least_height_;
}

// Whether two parts have a common vertex; both lists are ascending.
bool SelfContactTree::adjacent(const Node& a, const Node& b) const {
  const int *p = &vertex_[a.first_vertex], *q = &vertex_[b.first_vertex];
  const int *p_end = p + a.vertices, *q_end = q + b.vertices;
  while (p != p_end && q != q_end) {
    if (*p == *q) return true;
    if (*p < *q) {
      ++p;
    } else {
      ++q;
    }
  }
  return false;
}

}  // namespace vibe
