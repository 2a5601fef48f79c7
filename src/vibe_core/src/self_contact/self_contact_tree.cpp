// How the tree is built.
#include "self_contact/self_contact_tree.hpp"

#include <algorithm>
#include <numeric>

#include "vibe_core/solver/step_policy.hpp"

namespace vibe {

SelfContactTree::SelfContactTree(const SurfaceMesh& rest, const VertexTriangles& rings)
    : rough_cosine_(static_cast<float>(stepPolicy().tree_rough_cosine)),
      least_height_(static_cast<float>(stepPolicy().tree_least_height)),
      triangles_(rest.triangles),
      rings_(rings) {
  order_.resize(triangles_.size());
  std::iota(order_.begin(), order_.end(), 0);
  std::vector<Eigen::Vector3d> centre;
  for (const auto& t : triangles_)
    centre.push_back((rest.vertices[t[0]] + rest.vertices[t[1]] + rest.vertices[t[2]]) / 3);
  leaf_of_.resize(triangles_.size());
  if (!triangles_.empty()) build(0, static_cast<int>(order_.size()), centre);
  // Nodes are in the order in which they were built: the left child follows its parent.
  parent_.assign(nodes_.size(), -1);
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    const int index = static_cast<int>(n), right = limits_[n].right;
    if (right != 0) parent_[n + 1] = parent_[right] = index;
    for (int i = 0; right == 0 && i < nodes_[n].count; ++i) leaf_of_[order_[nodes_[n].first + i]] = index;
  }
  // All memory is taken here, so that a step allocates none.
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

// Halves the triangles at the median along the longest extent of their centres.
int SelfContactTree::build(int first, int count, const std::vector<Eigen::Vector3d>& centre) {
  const int index = static_cast<int>(nodes_.size());
  limits_.emplace_back();
  // Two lists of equal length: what a traversal reads of each node is kept apart from the rest.
  nodes_.push_back({{}, {}, {}, {}, first, count, 0, 0, 0, 0, 0, 0});
  listVertices(nodes_[index]);
  if (count <= stepPolicy().tree_leaf) {
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
  // Equal centres are ordered by number: the tree is the same everywhere.
  std::sort(order_.begin() + first, order_.begin() + first + count, [&](int a, int b) {
    return centre[a][axis] < centre[b][axis] || (centre[a][axis] == centre[b][axis] && a < b);
  });
  build(first, count / 2, centre);
  const int right = build(first + count / 2, count - count / 2, centre);
  limits_[index].right = right;
  return index;
}

// Only small connected parts may count as free of overhangs, and only their vertices are asked for.
void SelfContactTree::listVertices(Node& node) {
  node.first_vertex = static_cast<int>(vertex_.size());
  if (node.count > stepPolicy().tree_largest_graph || !isConnected(node)) return;
  for (int i = node.first; i < node.first + node.count; ++i)
    vertex_.insert(vertex_.end(), triangles_[order_[i]].begin(), triangles_[order_[i]].end());
  std::sort(vertex_.begin() + node.first_vertex, vertex_.end());
  vertex_.erase(std::unique(vertex_.begin() + node.first_vertex, vertex_.end()), vertex_.end());
  node.vertices = static_cast<int>(vertex_.size()) - node.first_vertex;
}

// Each vertex belongs to the leaf of its first triangle, so that a search meets it once.
void SelfContactTree::listOwned(Node& leaf) {
  leaf.first_owned = static_cast<int>(owned_.size());
  for (int i = leaf.first; i < leaf.first + leaf.count; ++i)
    for (const int v : triangles_[order_[i]])
      if (rings_.first(v) == order_[i]) owned_.push_back(v);
  leaf.owned = static_cast<int>(owned_.size()) - leaf.first_owned;
}

bool SelfContactTree::isConnected(const Node& node) const {
  // The search goes from one triangle over common vertices; parts are so small that all triangles may be compared.
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

// Leaves behind this one with a triangle within two edges.
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
  // The largest nodes that have no more than so many triangles.
  const int most = stepPolicy().tree_part;
  std::vector<int> part(ring_.size(), 0);
  int count = 0;
  for (std::size_t n = nodes_.size(); n-- > 0;) {
    const Node& node = nodes_[n];
    if (node.count > most || (n > 0 && nodes_[parent_[n]].count <= most)) continue;
    for (int i = node.first; i < node.first + node.count; ++i)
      for (const int v : triangles_[order_[i]]) part[v] = count;
    ++count;
  }
  return part;
}

}  // namespace vibe
