#include "self_contact/self_contact_tree.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

namespace vibe {

namespace {

constexpr int kLeaf = 4;           // triangles of a leaf. Design choice: boxes of so few are cheap to compare
constexpr int kLargestGraph = 64;  // triangles of a part that may count as free of overhangs. Design choice: about as
                                   // wide as the part of the surface that counts as one wall
constexpr float kLeastHeight = 0.1F;  // smallest cosine between normals and the direction without overhangs

constexpr int kPartTriangles = 64;  // triangles of a part that is renewed together. Design choice: about 10 mm wide
constexpr float kPositionRounding = 2.4e-7F;  // of a position in single precision, twice over [1]

using TreeBox = SelfContactTree::Box;

TreeBox joinBoxes(const TreeBox& a, const TreeBox& b) {
  return {a.low.min(b.low), a.minus_high.min(b.minus_high)};
}

}  // namespace

SelfContactTree::SelfContactTree(const SurfaceMesh& rest, const VertexTriangles& rings)
    : triangles_(rest.triangles), rings_(rings) {
  order_.resize(triangles_.size());
  std::iota(order_.begin(), order_.end(), 0);
  std::vector<Eigen::Vector3d> centre;
  for (const auto& t : triangles_)
    centre.push_back((rest.vertices[t[0]] + rest.vertices[t[1]] + rest.vertices[t[2]]) / 3);
  leaf_of_.resize(triangles_.size());
  if (!triangles_.empty()) build(0, static_cast<int>(order_.size()), centre);
  parent_.assign(nodes_.size(), -1);
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    const int index = static_cast<int>(n), right = limits_[n].right;
    if (right != 0) parent_[n + 1] = parent_[right] = index;
    for (int i = 0; right == 0 && i < nodes_[n].count; ++i) leaf_of_[order_[nodes_[n].first + i]] = index;
  }
  box_.resize(triangles_.size());
  own_.resize(triangles_.size());
  around_.resize(triangles_.size());
  changed_.resize(triangles_.size());
  ring_.resize(rest.vertices.size());
  ball_.resize(rest.vertices.size());
  renewed_.reserve(triangles_.size());
  renewed_nodes_.reserve(nodes_.size());
  stack_.reserve(nodes_.size());
}

// Halves at the median along the longest extent.
int SelfContactTree::build(int first, int count, const std::vector<Eigen::Vector3d>& centre) {
  const int index = static_cast<int>(nodes_.size());
  limits_.emplace_back();
  nodes_.push_back({{}, {}, {}, {}, first, count, 0, 0, 0, 0, 0, 0});
  listVertices(nodes_[index]);
  if (count <= kLeaf) {
    listOwned(nodes_[index]);
    return index;
  }
  Eigen::Vector3d low = centre[order_[first]], high = low;
  for (int i = first; i < first + count; ++i) {
    low = low.cwiseMin(centre[order_[i]]);
    high = high.cwiseMax(centre[order_[i]]);
  }
  Eigen::Index axis = 0;
  (high - low).maxCoeff(&axis);
  std::sort(order_.begin() + first, order_.begin() + first + count, [&](int a, int b) {
    return centre[a][axis] < centre[b][axis] || (centre[a][axis] == centre[b][axis] && a < b);
  });
  build(first, count / 2, centre);
  const int right = build(first + count / 2, count - count / 2, centre);
  limits_[index].right = right;
  return index;
}

void SelfContactTree::listVertices(Node& node) {
  node.first_vertex = static_cast<int>(vertex_.size());
  if (node.count > kLargestGraph || !isConnected(node)) return;
  for (int i = node.first; i < node.first + node.count; ++i)
    vertex_.insert(vertex_.end(), triangles_[order_[i]].begin(), triangles_[order_[i]].end());
  std::sort(vertex_.begin() + node.first_vertex, vertex_.end());
  vertex_.erase(std::unique(vertex_.begin() + node.first_vertex, vertex_.end()), vertex_.end());
  node.vertices = static_cast<int>(vertex_.size()) - node.first_vertex;
}

void SelfContactTree::listOwned(Node& leaf) {
  leaf.first_owned = static_cast<int>(owned_.size());
  for (int i = leaf.first; i < leaf.first + leaf.count; ++i)
    for (const int v : triangles_[order_[i]])
      if (rings_.first(v) == order_[i]) owned_.push_back(v);
  leaf.owned = static_cast<int>(owned_.size()) - leaf.first_owned;
}

bool SelfContactTree::isConnected(const Node& node) const {
  std::vector<char> reached(node.count, 0);
  std::vector<int> next(1, 0);
  reached[0] = 1;
  int count = 1;
  while (!next.empty()) {
    const auto& t = triangles_[order_[node.first + next.back()]];
    next.pop_back();
    for (int i = 0; i < node.count; ++i) {
      const auto& other = triangles_[order_[node.first + i]];
      if (reached[i] != 0 || std::find_first_of(t.begin(), t.end(), other.begin(), other.end()) == t.end()) continue;
      reached[i] = 1;
      ++count;
      next.push_back(i);
    }
  }
  return count == node.count;
}

void SelfContactTree::setWalls(const SurfaceWalls& walls) {
  same_wall_.clear();
  for (std::size_t n = 0; n < nodes_.size(); ++n) listSameWall(static_cast<int>(n), walls);
}

void SelfContactTree::listSameWall(int index, const SurfaceWalls& walls) {
  Node& node = nodes_[index];
  node.first_same = static_cast<int>(same_wall_.size());
  if (node.vertices > 0 && meetsOneWall(node, node, walls)) same_wall_.push_back(index);
  if (limits_[index].right == 0)
    for (const int other : laterLeavesAround(index))
      if (meetsOneWall(node, nodes_[other], walls) && meetsOneWall(nodes_[other], node, walls))
        same_wall_.push_back(other);
  node.same = static_cast<int>(same_wall_.size()) - node.first_same;
}

// Within two edges.
std::vector<int> SelfContactTree::laterLeavesAround(int leaf) const {
  std::vector<int> later;
  const auto add = [&](int t) {
    if (leaf_of_[t] > leaf) later.push_back(leaf_of_[t]);
  };
  for (int k = nodes_[leaf].first_vertex, end = k + nodes_[leaf].vertices; k < end; ++k)
    rings_.visit(vertex_[k], [&](int t) {
      for (const int v : triangles_[t]) rings_.visit(v, add);
    });
  std::sort(later.begin(), later.end());
  later.erase(std::unique(later.begin(), later.end()), later.end());
  return later;
}

// Whether each vertex of one, as far as its first triangle is there, belongs to the same wall as each triangle of the
// other.
bool SelfContactTree::meetsOneWall(const Node& a, const Node& b, const SurfaceWalls& walls) const {
  const int *first = &order_[b.first], *last = first + b.count;
  const auto reaches = [&](int v) {
    return std::all_of(first, last, [&](int u) {
      const auto& n = triangles_[u];
      return std::any_of(n.begin(), n.end(), [&](int w) { return walls.oneWall(v, w); });
    });
  };
  return std::all_of(&order_[a.first], &order_[a.first] + a.count, [&](int t) {
    const auto& n = triangles_[t];
    return std::all_of(n.begin(), n.end(), [&](int v) { return rings_.first(v) != t || reaches(v); });
  });
}

std::vector<int> SelfContactTree::parts() const {
  std::vector<int> part(ring_.size(), 0);
  int count = 0;
  for (std::size_t n = nodes_.size(); n-- > 0;) {
    const Node& node = nodes_[n];
    if (node.count > kPartTriangles || (n > 0 && nodes_[parent_[n]].count <= kPartTriangles)) continue;
    for (int i = node.first; i < node.first + node.count; ++i)
      for (const int v : triangles_[order_[i]]) part[v] = count;
    ++count;
  }
  return part;
}

void SelfContactTree::adapt(const SelfContactBounds& bounds, bool all) {
  forgetChanges();
  markChanges(bounds, all);
  for (const int t : renewed_) encloseTriangle(t, bounds);
  spread(bounds, all);
  for (const int t : renewed_)
    for (int n = leaf_of_[t]; n >= 0 && (limits_[n].changed | changed_[t]) != limits_[n].changed; n = parent_[n]) {
      if (limits_[n].changed == 0) renewed_nodes_.push_back(n);
      limits_[n].changed |= changed_[t];
    }
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
  if ((changed_[triangle] & kOwn) == 0) return;
  const auto& [normal, turn] = bounds.cone(triangle);
  Cone& own = own_[triangle];
  own = Cone();
  if (turn > 1) return;
  own.axis.head<3>() = normal;
  own.cosine = 1 - 0.5F * turn * turn;
  own.sine = turn * std::sqrt(1 - 0.25F * turn * turn);
}

// Normals of the triangles at the corners of those that have turned.
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
  if (all) {
    for (std::size_t v = 0; v < ring_.size(); ++v) spreadOver(static_cast<int>(v));
  } else {
    for (const int t : bounds.turned())
      for (const int v : triangles_[t]) spreadOver(v);
  }
  for (const int t : renewed_) {
    if ((changed_[t] & kAround) == 0) continue;
    const auto& n = triangles_[t];
    around_[t] = {(ring_[n[0]].axis + ring_[n[1]].axis + ring_[n[2]].axis).normalized(), 1, 0};
    for (const int v : n) widen(ring_[v], around_[t]);
  }
}

// About the same axis.
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

// Of the nodes that have changed.
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
bool SelfContactTree::isGraph(const Cone& a, const Cone& b) {
  return a.cosine > kLeastHeight && b.cosine > kLeastHeight && join(a, b).cosine > kLeastHeight;
}

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
