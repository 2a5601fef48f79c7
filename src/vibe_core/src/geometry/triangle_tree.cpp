#include "vibe_core/geometry/triangle_tree.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <utility>

#include <Eigen/Geometry>

#include "geometry/triangle_distance.hpp"

namespace vibe {

namespace {

constexpr int kLeafSize = 4;

/// Where a ray meets a triangle (Moeller and Trumbore 1997); infinity if it misses.
double hitTriangle(const Eigen::Vector3d& start, const Eigen::Vector3d& direction, const Eigen::Vector3d& a,
                   const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const double miss = std::numeric_limits<double>::infinity();
  const Eigen::Vector3d ab = b - a, ac = c - a;
  const Eigen::Vector3d h = direction.cross(ac);
  const double det = ab.dot(h);
  if (det == 0.0) return miss;
  const Eigen::Vector3d s = start - a;
  const double u = s.dot(h) / det;
  const Eigen::Vector3d q = s.cross(ab);
  const double v = direction.dot(q) / det;
  if (u < 0.0 || v < 0.0 || u + v > 1.0) return miss;
  const double t = ac.dot(q) / det;
  return t > 0.0 ? t : miss;
}

/// @param far  where the ray ends, in lengths of `direction`
bool rayMeetsBox(const Eigen::Vector3d& start, const Eigen::Vector3d& direction, const Eigen::AlignedBox3d& box,
                 double far = std::numeric_limits<double>::infinity()) {
  double near = 0.0;
  for (int k = 0; k < 3; ++k) {
    if (direction[k] == 0.0) {
      if (start[k] < box.min()[k] || start[k] > box.max()[k]) return false;
      continue;
    }
    const double t0 = (box.min()[k] - start[k]) / direction[k];
    const double t1 = (box.max()[k] - start[k]) / direction[k];
    near = std::max(near, std::min(t0, t1));
    far = std::min(far, std::max(t0, t1));
  }
  return near <= far;
}

}  // namespace

Eigen::Vector3d closestPointOnTriangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                       const Eigen::Vector3d& c) {
  const Eigen::Vector3d ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const Eigen::Vector3d bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + ab * (d1 / (d1 - d3));
  const Eigen::Vector3d cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + ac * (d2 / (d2 - d6));
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
  const double scale = 1.0 / (va + vb + vc);
  return a + ab * (vb * scale) + ac * (vc * scale);
}

TriangleTree::TriangleTree(SurfaceMesh mesh) : mesh_(std::move(mesh)), order_(mesh_.triangles.size()) {
  std::iota(order_.begin(), order_.end(), 0);
  nodes_.reserve(mesh_.triangles.size() + 1);
  if (!order_.empty()) build(0, static_cast<int>(order_.size()));
}

Eigen::AlignedBox3d TriangleTree::triangleBox(int triangle) const {
  Eigen::AlignedBox3d box;
  for (const int v : mesh_.triangles[triangle]) box.extend(mesh_.vertices[v]);
  return box;
}

int TriangleTree::build(int begin, int end) {
  const int number = static_cast<int>(nodes_.size());
  nodes_.emplace_back();
  Eigen::AlignedBox3d box, centres;
  for (int k = begin; k < end; ++k) {
    const Eigen::AlignedBox3d b = triangleBox(order_[k]);
    box.extend(b);
    centres.extend(b.center());
  }
  nodes_[number].box = box;
  nodes_[number].begin = begin;
  nodes_[number].end = end;
  if (end - begin <= kLeafSize) return number;

  // split by number along the longest side; the triangle number breaks ties of equal centres
  int axis = 0;
  centres.sizes().maxCoeff(&axis);
  const int middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end, [&](int a, int b) {
    const double ca = triangleBox(a).center()[axis], cb = triangleBox(b).center()[axis];
    return ca != cb ? ca < cb : a < b;
  });
  const int left = build(begin, middle);
  const int right = build(middle, end);
  nodes_[number].left = left;
  nodes_[number].right = right;
  return number;
}

TriangleTree::Hit TriangleTree::closest(const Eigen::Vector3d& p) const {
  Hit best;
  best.distance = std::numeric_limits<double>::infinity();
  if (!nodes_.empty()) closest(0, p, best);
  return best;
}

void TriangleTree::closest(int node, const Eigen::Vector3d& p, Hit& best) const {
  const Node& n = nodes_[node];
  if (n.left < 0) {
    for (int k = n.begin; k < n.end; ++k) {
      const auto& t = mesh_.triangles[order_[k]];
      const Eigen::Vector3d q =
          closestPointOnTriangle(p, mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]);
      const double distance = (q - p).norm();
      if (distance < best.distance) best = {q, order_[k], distance};
    }
    return;
  }
  int first = n.left, second = n.right;
  double d1 = nodes_[first].box.exteriorDistance(p), d2 = nodes_[second].box.exteriorDistance(p);
  if (d2 < d1) {
    std::swap(first, second);
    std::swap(d1, d2);
  }
  if (d1 < best.distance) closest(first, p, best);
  if (d2 < best.distance) closest(second, p, best);
}

double TriangleTree::firstHit(const Eigen::Vector3d& start, const Eigen::Vector3d& direction) const {
  double nearest = std::numeric_limits<double>::infinity();
  std::vector<int> open;
  if (!nodes_.empty()) open.push_back(0);
  while (!open.empty()) {
    const Node& n = nodes_[open.back()];
    open.pop_back();
    if (!rayMeetsBox(start, direction, n.box)) continue;
    if (n.left >= 0) {
      open.push_back(n.left);
      open.push_back(n.right);
      continue;
    }
    for (int k = n.begin; k < n.end; ++k) {
      const auto& t = mesh_.triangles[order_[k]];
      nearest = std::min(
          nearest, hitTriangle(start, direction, mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]));
    }
  }
  return nearest;
}

bool TriangleTree::isBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
  const Eigen::Vector3d way = to - from;
  std::array<int, 64> open;  // halving leaves one entry per level at most
  std::size_t count = 0;
  if (!nodes_.empty()) open[count++] = 0;
  while (count > 0) {
    const Node& n = nodes_[open[--count]];
    if (!rayMeetsBox(from, way, n.box, 1)) continue;
    if (n.left >= 0) {
      open[count++] = n.left;
      open[count++] = n.right;
      continue;
    }
    for (int k = n.begin; k < n.end; ++k) {
      const auto& t = mesh_.triangles[order_[k]];
      if (hitTriangle(from, way, mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]) < 1) return true;
    }
  }
  return false;
}

void TriangleTree::moveTo(const std::vector<double>& x, const std::vector<double>& y, const std::vector<double>& z) {
  for (std::size_t v = 0; v < mesh_.vertices.size(); ++v) mesh_.vertices[v] = {x[v], y[v], z[v]};
  for (std::size_t k = nodes_.size(); k-- > 0;) {  // children come after their parents
    Node& n = nodes_[k];
    if (n.left >= 0) {
      n.box = nodes_[n.left].box.merged(nodes_[n.right].box);
      continue;
    }
    n.box.setEmpty();
    for (int i = n.begin; i < n.end; ++i) n.box.extend(triangleBox(order_[i]));
  }
}

void TriangleTree::overlappingPairs(const std::function<bool(int, int)>& visit) const {
  if (!nodes_.empty()) pairs(0, 0, visit);
}

bool TriangleTree::pairs(int a, int b, const std::function<bool(int, int)>& visit) const {
  const Node& na = nodes_[a];
  const Node& nb = nodes_[b];
  if (!na.box.intersects(nb.box)) return true;
  if (na.left < 0 && nb.left < 0) return leafPairs(na, nb, a == b, visit);
  if (a == b)
    return pairs(na.left, na.left, visit) && pairs(na.left, na.right, visit) && pairs(na.right, na.right, visit);
  // descend into the node with more triangles
  if (nb.left < 0 || (na.left >= 0 && na.end - na.begin >= nb.end - nb.begin)) {
    return pairs(na.left, b, visit) && pairs(na.right, b, visit);
  }
  return pairs(a, nb.left, visit) && pairs(a, nb.right, visit);
}

bool TriangleTree::leafPairs(const Node& a, const Node& b, bool same,
                             const std::function<bool(int, int)>& visit) const {
  for (int i = a.begin; i < a.end; ++i) {
    for (int k = same ? i + 1 : b.begin; k < b.end; ++k) {
      const auto [low, high] = std::minmax(order_[i], order_[k]);
      if (!triangleBox(low).intersects(triangleBox(high))) continue;
      if (!visit(low, high)) return false;
    }
  }
  return true;
}

namespace {

using Triangle = std::array<int, 3>;

/// Six times the signed volume of a tetrahedron.
double orientation(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                   const Eigen::Vector3d& d) {
  return (b - a).cross(c - a).dot(d - a);
}

/// Whether the open segment p, q passes through the inside of the triangle.
bool pierces(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
             const Eigen::Vector3d& c) {
  const double side_p = orientation(a, b, c, p), side_q = orientation(a, b, c, q);
  if (side_p * side_q >= 0.0) return false;
  const double ab = orientation(p, q, a, b), bc = orientation(p, q, b, c), ca = orientation(p, q, c, a);
  return (ab > 0.0 && bc > 0.0 && ca > 0.0) || (ab < 0.0 && bc < 0.0 && ca < 0.0);
}

/// Whether an edge of `first` pierces `second`. Edges that start at a shared vertex can only touch it there.
bool edgesPierce(const SurfaceMesh& mesh, const Triangle& first, const Triangle& second) {
  for (int k = 0; k < 3; ++k) {
    const int p = first[k], q = first[(k + 1) % 3];
    if (hasVertex(second, p) || hasVertex(second, q)) continue;
    if (pierces(mesh.vertices[p], mesh.vertices[q], mesh.vertices[second[0]], mesh.vertices[second[1]],
                mesh.vertices[second[2]])) {
      return true;
    }
  }
  return false;
}

}  // namespace

std::pair<int, int> findSelfIntersection(const TriangleTree& tree) {
  const SurfaceMesh& mesh = tree.mesh();
  std::pair<int, int> found(-1, -1);
  tree.overlappingPairs([&](int a, int b) {
    const Triangle &first = mesh.triangles[a], &second = mesh.triangles[b];
    const auto shared = std::count_if(first.begin(), first.end(), [&](int v) { return hasVertex(second, v); });
    if (shared >= 2) return true;  // neighbours at an edge meet only there, unless folded flat
    if (!edgesPierce(mesh, first, second) && !edgesPierce(mesh, second, first)) return true;
    found = {a, b};
    return false;
  });
  return found;
}

}  // namespace vibe
