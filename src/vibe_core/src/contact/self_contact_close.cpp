#include "contact/self_contact_close.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

#include "contact/self_contact_distance.hpp"

namespace vibe {

namespace {

/// Dijkstra's shortest paths along edges from a vertex, as far as a reach.
class NearVertices {
 public:
  NearVertices(const SurfaceMesh& mesh, double reach)
      : mesh_(mesh),
        reach_(reach),
        neighbours_(vertexNeighbours(mesh)),
        length_(mesh.vertices.size(), std::numeric_limits<double>::infinity()) {}

  /// Also those within two edges, ascending.
  const std::vector<int>& of(int vertex) {
    search(vertex);
    for (const int v : found_) length_[v] = std::numeric_limits<double>::infinity();
    for (const int v : neighbours_[vertex]) {
      found_.push_back(v);
      found_.insert(found_.end(), neighbours_[v].begin(), neighbours_[v].end());
    }
    std::sort(found_.begin(), found_.end());
    found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
    return found_;
  }

 private:
  using Entry = std::pair<double, int>;

  void search(int vertex) {
    length_[vertex] = 0;
    queue_.push({0, vertex});
    found_.assign(1, vertex);
    while (!queue_.empty()) {
      const auto [far, v] = queue_.top();
      queue_.pop();
      if (far > length_[v]) continue;
      for (const int w : neighbours_[v]) {
        const double there = far + (mesh_.vertices[v] - mesh_.vertices[w]).norm();
        if (there > reach_ || there >= length_[w]) continue;
        if (length_[w] == std::numeric_limits<double>::infinity()) found_.push_back(w);
        length_[w] = there;
        queue_.push({there, w});
      }
    }
  }

  const SurfaceMesh& mesh_;
  double reach_;
  std::vector<std::vector<int>> neighbours_;
  std::vector<double> length_;
  std::vector<int> found_;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> queue_;
};

}  // namespace

SurfaceWalls::SurfaceWalls(const SurfaceMesh& rest, double reach) : start_(1, 0) {
  NearVertices near(rest, reach);
  for (int i = 0; i < static_cast<int>(rest.vertices.size()); ++i) {
    const std::vector<int>& vertices = near.of(i);
    wall_.insert(wall_.end(), vertices.begin(), vertices.end());
    start_.push_back(static_cast<int>(wall_.size()));
  }
}

namespace {

constexpr int kNone = -1;            // node that has no part in a place
constexpr double kEqual = 1 - 1e-9;  // ratio of two squared distances that are the same but for rounding

bool isBefore(const ClosePoints& a, const ClosePoints& b) {
  return a.split < b.split || (a.split == b.split && a.node < b.node);
}

bool isSame(const ClosePoints& a, const ClosePoints& b) {
  return a.split == b.split && a.node == b.node;
}

}  // namespace

const std::vector<ClosePoints>& SelfContactClose::find(const std::vector<Pair>& pairs,
                                                       const std::array<std::vector<double>, 3>& at, double distance) {
  at_ = &at;
  distance_ = distance;
  places_.clear();
  for (const Pair& pair : pairs) {
    if (apart(pair)) continue;
    addVertices(pair[0], pair[1]);
    addVertices(pair[1], pair[0]);
    addEdges(pair[0], pair[1]);
  }
  std::sort(places_.begin(), places_.end(), isBefore);
  places_.erase(std::unique(places_.begin(), places_.end(), isSame), places_.end());
  places_.erase(std::remove_if(places_.begin(), places_.end(), [this](const ClosePoints& p) { return !isNearest(p); }),
                places_.end());
  return places_;
}

Eigen::Vector3d SelfContactClose::at(int node) const {
  return {(*at_)[0][node], (*at_)[1][node], (*at_)[2][node]};
}

// Boxes around the two triangles.
bool SelfContactClose::apart(const Pair& pair) const {
  const std::array<int, 3>&a = triangles_[pair[0]], &b = triangles_[pair[1]];
  for (std::size_t k = 0; k < 3; ++k) {
    const std::vector<double>& x = (*at_)[k];
    const auto [low_a, high_a] = std::minmax({x[a[0]], x[a[1]], x[a[2]]});
    const auto [low_b, high_b] = std::minmax({x[b[0]], x[b[1]], x[b[2]]});
    if (low_a - high_b >= distance_ || low_b - high_a >= distance_) return true;
  }
  return false;
}

void SelfContactClose::addVertices(int of, int triangle) {
  std::array<int, 3> n = triangles_[triangle];
  std::sort(n.begin(), n.end());
  for (const int v : triangles_[of]) {
    if (hasVertex(n, v)) continue;
    const TriangleFoot foot = triangleFoot(at(v), at(n[0]), at(n[1]), at(n[2]));
    if (!(foot.away.squaredNorm() < distance_ * distance_)) continue;
    ClosePoints close{{v, kNone, kNone, kNone}, 1, {1, 0, 0, 0}, foot.away, 1, false};
    for (std::size_t k = 0, next = 1; k < 3; ++k) {
      const double weight = foot.weight[static_cast<Eigen::Index>(k)];
      if (weight > 0) close.node[next] = n[k], close.weight[next++] = -weight;
    }
    close.in_wall = isInWall(close);
    places_.push_back(close);
  }
}

void SelfContactClose::addEdges(int one, int other) {
  const std::array<int, 3>&a = triangles_[one], &b = triangles_[other];
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t l = 0; l < 3; ++l) {
      const std::array<int, 2> p{a[k], a[(k + 1) % 3]}, q{b[l], b[(l + 1) % 3]};
      if (p[0] == q[0] || p[0] == q[1] || p[1] == q[0] || p[1] == q[1]) continue;
      addEdgePair({std::min(p[0], p[1]), std::max(p[0], p[1])}, {std::min(q[0], q[1]), std::max(q[0], q[1])});
    }
}

// Where the nearest points are inside both edges: otherwise a vertex is nearer.
void SelfContactClose::addEdgePair(std::array<int, 2> one, std::array<int, 2> other) {
  if (other < one) std::swap(one, other);
  const Eigen::Vector3d from = at(one[0]), to = at(other[0]);
  const Eigen::Vector3d u = at(one[1]) - from, v = at(other[1]) - to, r = from - to;
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v), across = uu * vv - uv * uv;
  if (!(across > 0)) return;
  const double s = (uv * v.dot(r) - u.dot(r) * vv) / across, t = (uu * v.dot(r) - uv * u.dot(r)) / across;
  if (!(s > 0 && s < 1 && t > 0 && t < 1)) return;
  const Eigen::Vector3d away = r + s * u - t * v;
  if (!(away.squaredNorm() < distance_ * distance_)) return;
  places_.push_back({{one[0], one[1], other[0], other[1]}, 2, {1 - s, s, t - 1, -t}, away, across / (uu * vv), false});
  places_.back().in_wall = isInWall(places_.back());
}

bool SelfContactClose::isInWall(const ClosePoints& place) const {
  for (int i = 0; i < place.split; ++i)
    for (std::size_t j = place.split; j < 4; ++j)
      if (place.node[j] >= 0 && walls_.oneWall(place.node[i], place.node[j])) return true;
  return false;
}

// Whether no triangle around the point opposite to a vertex is nearer.
bool SelfContactClose::isNearest(const ClosePoints& place) const {
  if (place.split == 2 || place.node[3] != kNone) return true;
  const Eigen::Vector3d vertex = at(place.node[0]);
  const double least = kEqual * place.away.squaredNorm();
  bool nearest = true;
  rings_.visit(place.node[1], [&](int t) {
    const auto& n = triangles_[t];
    if (!nearest || (place.node[2] != kNone && !hasVertex(n, place.node[2]))) return;
    nearest = triangleFoot(vertex, at(n[0]), at(n[1]), at(n[2])).away.squaredNorm() >= least;
  });
  return nearest;
}

}  // namespace vibe
