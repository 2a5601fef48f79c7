#include "contact/self_contact_tree.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace vibe {

namespace {

constexpr int kLeaf = 4;           // triangles of a leaf. Design choice: boxes of so few are cheap to compare
constexpr int kLargestGraph = 64;  // triangles of a part that may count as free of overhangs. Design choice: about as
                                   // wide as the part of the surface that counts as one wall
constexpr float kLeastHeight = 0.1F;  // smallest cosine between normals and the direction without overhangs

using Directions = SelfContactTree::Directions;

Directions join(const Directions& a, const Directions& b) {
  return {a.low.cwiseMin(b.low), a.high.cwiseMax(b.high), std::max(a.turn, b.turn)};
}

}  // namespace

SelfContactTree::SelfContactTree(const SurfaceMesh& rest) : triangles_(rest.triangles) {
  order_.resize(triangles_.size());
  std::iota(order_.begin(), order_.end(), 0);
  std::vector<Eigen::Vector3d> centre;
  for (const auto& t : triangles_)
    centre.push_back((rest.vertices[t[0]] + rest.vertices[t[1]] + rest.vertices[t[2]]) / 3);
  if (!triangles_.empty()) build(0, static_cast<int>(order_.size()), centre);
  box_.resize(triangles_.size());
  directions_.resize(triangles_.size());
  ring_directions_.resize(rest.vertices.size());
}

// Halves at the median along the longest extent.
int SelfContactTree::build(int first, int count, const std::vector<Eigen::Vector3d>& centre) {
  const int index = static_cast<int>(nodes_.size());
  nodes_.push_back({{}, {}, first, count, 0, 0, 0});
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
  nodes_[index].right = right;
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

void SelfContactTree::enclose(const std::vector<Eigen::Vector3d>& start, const std::vector<Eigen::Vector3d>& end,
                              double margin, double slack, bool rings) {
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    encloseTriangle(static_cast<int>(t), start, end, margin + slack, slack);
  if (rings) spreadOverRings();
  for (std::size_t n = nodes_.size(); n-- > 0;) {
    Node& node = nodes_[n];
    if (node.right != 0) {
      const Node &a = nodes_[n + 1], &b = nodes_[node.right];
      node.box = {a.box.low.cwiseMin(b.box.low), a.box.high.cwiseMax(b.box.high)};
      node.directions = join(a.directions, b.directions);
      continue;
    }
    node.box = box_[order_[node.first]];
    node.directions = directions_[order_[node.first]];
    for (int i = node.first + 1; i < node.first + node.count; ++i) {
      const int t = order_[i];
      node.box = {node.box.low.cwiseMin(box_[t].low), node.box.high.cwiseMax(box_[t].high)};
      node.directions = join(node.directions, directions_[t]);
    }
  }
}

// The area vector along straight paths is a quadratic Bezier curve, a positive combination of its three control points.
void SelfContactTree::encloseTriangle(int triangle, const std::vector<Eigen::Vector3d>& start,
                                      const std::vector<Eigen::Vector3d>& end, double margin, double slack) {
  const auto& t = triangles_[triangle];
  const Eigen::Vector3d &a = start[t[0]], &b = start[t[1]], &c = start[t[2]];
  Box& box = box_[triangle];
  box.low = a.cwiseMin(b).cwiseMin(c);
  box.high = a.cwiseMax(b).cwiseMax(c);
  const Eigen::Vector3d ab = b - a, ac = c - a, area = ab.cross(ac);
  const double size2 = area.squaredNorm();
  const Eigen::Vector3f normal = (area / std::sqrt(size2)).cast<float>();
  Directions& directions = directions_[triangle];
  directions = {normal, normal, 0};
  double turn2 = 0;  // square of how far the slack turns the normal: twice the slack over the least height
  if (slack > 0)
    turn2 = 4 * slack * slack * std::max({ab.squaredNorm(), ac.squaredNorm(), (c - b).squaredNorm()}) / size2;
  if (&start != &end) {
    const Eigen::Vector3d &d = end[t[0]], &e = end[t[1]], &f = end[t[2]];
    box.low = box.low.cwiseMin(d).cwiseMin(e).cwiseMin(f);
    box.high = box.high.cwiseMax(d).cwiseMax(e).cwiseMax(f);
    const Eigen::Vector3d de = e - d, df = f - d;
    const Eigen::Vector3f middle = (ab.cross(df) + de.cross(ac)).normalized().cast<float>();
    const Eigen::Vector3f last = de.cross(df).normalized().cast<float>();
    directions.low = directions.low.cwiseMin(middle).cwiseMin(last);
    directions.high = directions.high.cwiseMax(middle).cwiseMax(last);
  }
  box.low.array() -= margin;
  box.high.array() += margin;
  if (!(size2 > 0 && turn2 < 1)) {  // it may point anywhere
    directions = {Eigen::Vector3f::Constant(-1), Eigen::Vector3f::Constant(1), 0};
  } else {
    directions.turn = static_cast<float>(std::sqrt(turn2));
  }
}

void SelfContactTree::spreadOverRings() {
  for (Directions& ring : ring_directions_) ring = {Eigen::Vector3f::Constant(2), Eigen::Vector3f::Constant(-2), 0};
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    for (const int v : triangles_[t]) ring_directions_[v] = join(ring_directions_[v], directions_[t]);
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    for (const int v : triangles_[t]) directions_[t] = join(directions_[t], ring_directions_[v]);
}

float SelfContactTree::smallestCosine(const Directions& a, const Directions& b) {
  const auto ll = a.low.cwiseProduct(b.low), lh = a.low.cwiseProduct(b.high), hl = a.high.cwiseProduct(b.low),
             hh = a.high.cwiseProduct(b.high);
  return ll.cwiseMin(lh).cwiseMin(hl).cwiseMin(hh).sum() - a.turn - b.turn;
}

// Whether the union of two parts is connected and the normals of both have a common direction without overhangs.
bool SelfContactTree::isGraph(int a, int b) const {
  const Node &one = nodes_[a], &other = nodes_[b];
  if (one.vertices == 0 || other.vertices == 0) return false;
  const Directions all = join(one.directions, other.directions);
  const Eigen::Vector3f up = all.low + all.high;
  const float least = up.cwiseProduct(all.low).cwiseMin(up.cwiseProduct(all.high)).sum();
  return least > (kLeastHeight + all.turn) * up.norm() && (a == b || adjacent(one, other));
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
