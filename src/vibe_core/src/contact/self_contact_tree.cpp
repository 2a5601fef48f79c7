#include "contact/self_contact_tree.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <numeric>

namespace vibe {

namespace {

constexpr int kLeaf = 4;           // triangles of a leaf. Design choice: boxes of so few are cheap to compare
constexpr int kLargestGraph = 64;  // triangles of a part that may count as free of overhangs. Design choice: about as
                                   // wide as the part of the surface that counts as one wall
constexpr float kLeastHeight = 0.1F;  // smallest cosine between normals and the direction without overhangs

constexpr float kRounding = 2.4e-7F;  // of a position in single precision, twice over [1]

using Box = SelfContactTree::Box;
using Directions = SelfContactTree::Directions;

Box join(const Box& a, const Box& b) {
  return {a.low.cwiseMin(b.low), a.high.cwiseMax(b.high)};
}

Directions join(const Directions& a, const Directions& b) {
  return {a.low.cwiseMin(b.low), a.high.cwiseMax(b.high), std::max(a.turn, b.turn)};
}

}  // namespace

SelfContactTree::SelfContactTree(const SurfaceMesh& rest, const VertexTriangles& rings)
    : triangles_(rest.triangles), rings_(rings) {
  order_.resize(triangles_.size());
  std::iota(order_.begin(), order_.end(), 0);
  std::vector<Eigen::Vector3d> centre;
  for (const auto& t : triangles_)
    centre.push_back((rest.vertices[t[0]] + rest.vertices[t[1]] + rest.vertices[t[2]]) / 3);
  if (!triangles_.empty()) build(0, static_cast<int>(order_.size()), centre);
  box_.resize(triangles_.size());
  own_.resize(triangles_.size());
  around_.resize(triangles_.size());
  changed_.resize(triangles_.size());
  ring_.resize(rest.vertices.size());
}

// Halves at the median along the longest extent.
int SelfContactTree::build(int first, int count, const std::vector<Eigen::Vector3d>& centre) {
  const int index = static_cast<int>(nodes_.size());
  limits_.emplace_back();
  nodes_.push_back({{}, {}, {}, first, count, 0, 0});
  listVertices(nodes_[index]);
  if (count <= kLeaf) return index;
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

void SelfContactTree::adapt(const SelfContactBounds& bounds, bool all) {
  forgetChanges();
  if (all) {
    std::fill(changed_.begin(), changed_.end(), char{kEverything});
  } else {
    for (const int v : bounds.moved()) rings_.visit(v, [this](int t) { changed_[t] |= kBox; });
    for (const int t : bounds.turned()) changed_[t] |= kOwn;
  }
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    if (changed_[t] != 0) encloseTriangle(static_cast<int>(t), bounds);
  spread(bounds, all);
  joinChildren();
}

void SelfContactTree::forgetChanges() {
  std::fill(changed_.begin(), changed_.end(), char{0});
  for (std::size_t n = 0; n < limits_.size(); ++n) {
    if (limits_[n].changed != 0) nodes_[n].before = nodes_[n].own;
    limits_[n].changed = 0;
  }
}

void SelfContactTree::encloseTriangle(int triangle, const SelfContactBounds& bounds) {
  Box& box = box_[triangle];
  box = {Eigen::Vector3f::Constant(std::numeric_limits<float>::infinity()),
         Eigen::Vector3f::Constant(-std::numeric_limits<float>::infinity())};
  for (const int v : triangles_[triangle]) {
    const Eigen::Vector3f centre = bounds.centre()[v].cast<float>();
    const Eigen::Vector3f radius = (kRounding * centre.cwiseAbs()).array() + static_cast<float>(bounds.radius(v));
    box.low = box.low.cwiseMin(centre - radius);
    box.high = box.high.cwiseMax(centre + radius);
  }
  const SelfContactBounds::Cone& cone = bounds.cone(triangle);
  if (cone.turn > 1) {
    own_[triangle] = {Eigen::Vector3f::Constant(-1), Eigen::Vector3f::Constant(1), 0};
  } else {
    own_[triangle] = {cone.normal, cone.normal, cone.turn};
  }
}

// Directions of the triangles at the corners of those that have turned.
void SelfContactTree::spread(const SelfContactBounds& bounds, bool all) {
  const auto spreadOver = [this](int v) {
    ring_[v] = {Eigen::Vector3f::Constant(2), Eigen::Vector3f::Constant(-2), 0};
    rings_.visit(v, [&](int t) { ring_[v] = join(ring_[v], own_[t]); });
    rings_.visit(v, [&](int t) { changed_[t] |= kAround; });
  };
  if (all) {
    for (std::size_t v = 0; v < ring_.size(); ++v) spreadOver(static_cast<int>(v));
  } else {
    for (const int t : bounds.turned())
      for (const int v : triangles_[t]) spreadOver(v);
  }
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    if ((changed_[t] & kAround) == 0) continue;
    const auto& n = triangles_[t];
    around_[t] = join(join(ring_[n[0]], ring_[n[1]]), ring_[n[2]]);
  }
}

void SelfContactTree::joinChildren() {
  for (std::size_t n = nodes_.size(); n-- > 0;) {
    Limits& limits = limits_[n];
    if (limits.right == 0) {
      joinTriangles(n);
      continue;
    }
    const Limits &a = limits_[n + 1], &b = limits_[limits.right];
    limits.changed = static_cast<char>(a.changed | b.changed);
    if (limits.changed == 0) continue;
    limits.box = join(a.box, b.box);
    const Node &one = nodes_[n + 1], &other = nodes_[limits.right];
    nodes_[n].own = join(one.own, other.own);
    nodes_[n].around = join(one.around, other.around);
  }
}

void SelfContactTree::joinTriangles(std::size_t leaf) {
  Limits& limits = limits_[leaf];
  Node& node = nodes_[leaf];
  for (int i = node.first; i < node.first + node.count; ++i) limits.changed |= changed_[order_[i]];
  if (limits.changed == 0) return;
  limits.box = box_[order_[node.first]];
  node.own = own_[order_[node.first]];
  node.around = around_[order_[node.first]];
  for (int i = node.first + 1; i < node.first + node.count; ++i) {
    const int t = order_[i];
    limits.box = join(limits.box, box_[t]);
    node.own = join(node.own, own_[t]);
    node.around = join(node.around, around_[t]);
  }
}

// Whether the normals of two parts have a common direction without overhangs.
bool SelfContactTree::isGraph(const Directions& a, const Directions& b) {
  const Directions all = join(a, b);
  const Eigen::Vector3f up = all.low + all.high;
  const float least = up.cwiseProduct(all.low).cwiseMin(up.cwiseProduct(all.high)).sum();
  return least > (kLeastHeight + all.turn) * up.norm();
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
