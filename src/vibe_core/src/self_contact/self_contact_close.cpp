#include "self_contact/self_contact_close.hpp"

#include <algorithm>
#include <cstdint>
#include <tuple>
#include <utility>

#include "geometry/triangle_distance.hpp"
#include "threads/lending_pool.hpp"
#include "vibe_core/threads/thread_pool.hpp"

namespace vibe {

namespace {

constexpr int kNone = -1;            // node that has no part in a spot
constexpr int kPiece = 256;          // triangles that one thread looks at in a row: sizes of lists depend on it
constexpr double kEqual = 1 - 1e-9;  // ratio of two squared distances that are the same but for rounding

// A spot that is found from several triangles has other roundings in each: the first in this order stays.
bool isBefore(const ClosePoints& a, const ClosePoints& b) {
  return std::tie(a.split, a.node, a.weight) < std::tie(b.split, b.node, b.weight);
}

bool isSame(const ClosePoints& a, const ClosePoints& b) {
  return a.split == b.split && a.node == b.node;
}

// Turns counts per owner into where the entries of each begin.
void accumulate(std::vector<int>& counts) {
  int sum = 0;
  for (int& count : counts) sum += std::exchange(count, sum);
}

}  // namespace

SelfContactClose::SelfContactClose(const std::vector<std::array<int, 3>>& triangles, const VertexTriangles& rings,
                                   const SurfaceWalls& walls)
    : triangles_(triangles),
      rings_(rings),
      walls_(walls),
      of_vertex_(rings.vertexCount() + 1),
      of_triangle_(triangles.size() + 1),
      found_((triangles.size() + kPiece - 1) / kPiece) {
  listEdges();
}

/// What one triangle has met already. Each thread that looks borrows some.
class SelfContactClose::Marks {
 public:
  void begin(std::size_t triangles, std::size_t vertices, std::size_t edges) {
    const std::size_t count[] = {triangles, vertices, edges};
    for (std::size_t k = 0; k < 3; ++k)
      if (marks_[k].size() < count[k]) marks_[k].resize(count[k], 0);
  }
  void nextTriangle() {
    if (++now_ != 0) return;
    for (std::vector<std::uint32_t>& marks : marks_) std::fill(marks.begin(), marks.end(), 0);
    now_ = 1;
  }
  bool meetsTriangle(int t) { return meets(0, t); }  // for the first time
  bool meetsVertex(int v) { return meets(1, v); }
  bool meetsEdge(int e) { return meets(2, e); }

 private:
  bool meets(std::size_t kind, int which) {
    return std::exchange(marks_[kind][static_cast<std::size_t>(which)], now_) != now_;
  }
  std::array<std::vector<std::uint32_t>, 3> marks_;  // the last triangle that has met each, as now_ was
  std::uint32_t now_ = 0;
};

void SelfContactClose::listEdges() {
  const auto edge = [](const std::array<int, 3>& t, std::size_t k) -> Edge {
    return {std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])};
  };
  for (const auto& t : triangles_)
    for (std::size_t k = 0; k < 3; ++k) edges_.push_back(edge(t, k));
  std::sort(edges_.begin(), edges_.end());
  edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
  edge_of_.resize(triangles_.size());
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      edge_of_[t][k] =
          static_cast<int>(std::lower_bound(edges_.begin(), edges_.end(), edge(triangles_[t], k)) - edges_.begin());
}

const std::vector<ClosePoints>& SelfContactClose::find(const std::vector<Facing>& facing,
                                                       const std::array<std::vector<double>, 3>& at, double distance,
                                                       ThreadPool* pool) {
  at_ = &at;
  distance_ = distance;
  spots_.clear();
  if (facing.empty()) return spots_;
  listFacing(facing);
  collect(pool);
  std::sort(spots_.begin(), spots_.end(), isBefore);
  spots_.erase(std::unique(spots_.begin(), spots_.end(), isSame), spots_.end());
  spots_.erase(std::remove_if(spots_.begin(), spots_.end(), [this](const ClosePoints& p) { return !isNearest(p); }),
               spots_.end());
  return spots_;
}

void SelfContactClose::listFacing(const std::vector<Facing>& facing) {
  for (std::vector<int>* starts : {&of_vertex_, &of_triangle_}) std::fill(starts->begin(), starts->end(), 0);
  facing_triangle_.clear();
  facing_vertex_.resize(facing.size());
  for (const Facing& one : facing) {
    ++of_vertex_[one.vertex], ++of_triangle_[one.triangle];
    facing_triangle_.push_back(one.triangle);
  }
  accumulate(of_vertex_), accumulate(of_triangle_);
  // Filling moves each start to that of the next triangle; rotating moves them back.
  for (const Facing& one : facing) facing_vertex_[of_triangle_[one.triangle]++] = one.vertex;
  std::rotate(of_triangle_.begin(), of_triangle_.end() - 1, of_triangle_.end());
  of_triangle_[0] = 0;
}

// The spots of the pieces are joined in the order in which one thread would find them.
void SelfContactClose::collect(ThreadPool* pool) {
  const int count = static_cast<int>(triangles_.size());
  if (pool == nullptr || pool->threads() == 1) return findAmong(0, count, spots_);
  pool->parallelFor(count, kPiece, [this](int first, int last) {
    std::vector<ClosePoints>& spots = found_[static_cast<std::size_t>(first / kPiece)];
    spots.clear();
    findAmong(first, last, spots);
  });
  for (const std::vector<ClosePoints>& spots : found_) spots_.insert(spots_.end(), spots.begin(), spots.end());
}

void SelfContactClose::findAmong(int first, int last, std::vector<ClosePoints>& spots) const {
  const LendingPool<Marks>::Loan marks;
  marks->begin(triangles_.size(), rings_.vertexCount(), edges_.size());
  Scan scan{*marks.operator->(), spots, {}, {}};
  for (int t = first; t < last; ++t) findAt(t, scan);
}

// Compares a triangle with all triangles around the vertices that face it, and with all that its own vertices face.
void SelfContactClose::findAt(int triangle, Scan& scan) const {
  const auto& n = triangles_[triangle];
  const bool faces = std::any_of(n.begin(), n.end(), [&](int v) { return of_vertex_[v] < of_vertex_[v + 1]; });
  if (!faces && of_triangle_[triangle] == of_triangle_[triangle + 1]) return;
  const Eigen::Vector3d a = at(n[0]), b = at(n[1]), c = at(n[2]);
  // Most others are outside of the box around the triangle, grown by the distance.
  scan.low = a.cwiseMin(b).cwiseMin(c).array() - distance_;
  scan.high = a.cwiseMax(b).cwiseMax(c).array() + distance_;
  scan.marks.nextTriangle();
  for (int i = of_triangle_[triangle]; i < of_triangle_[triangle + 1]; ++i)
    rings_.visit(facing_vertex_[i], [&](int other) { meet(triangle, other, scan); });
  for (const int v : n)
    for (int i = of_vertex_[v]; i < of_vertex_[v + 1]; ++i) meet(triangle, facing_triangle_[i], scan);
}

void SelfContactClose::meet(int triangle, int other, Scan& scan) const {
  if (!scan.marks.meetsTriangle(other) || isFar(triangles_[other], scan)) return;
  addVertices(triangle, other, scan);
  addEdges(triangle, other, scan);
}

// Whether the box around nodes is outside of that around the triangle that is looked at.
template <std::size_t Count>
bool SelfContactClose::isFar(const std::array<int, Count>& nodes, const Scan& scan) const {
  for (Eigen::Index k = 0; k < 3; ++k) {
    const std::vector<double>& x = (*at_)[static_cast<std::size_t>(k)];
    double least = x[nodes[0]], most = least;
    for (std::size_t i = 1; i < Count; ++i) least = std::min(least, x[nodes[i]]), most = std::max(most, x[nodes[i]]);
    if (least >= scan.high[k] || most <= scan.low[k]) return true;
  }
  return false;
}

void SelfContactClose::addVertices(int triangle, int other, Scan& scan) const {
  // In ascending order of its nodes a spot on a common edge is the same from both sides.
  std::array<int, 3> n = triangles_[triangle];
  std::sort(n.begin(), n.end());
  for (const int v : triangles_[other]) {
    if (!scan.marks.meetsVertex(v) || hasVertex(n, v)) continue;
    if (isFar(std::array<int, 1>{v}, scan)) continue;
    const TriangleFoot foot = triangleFoot(at(v), at(n[0]), at(n[1]), at(n[2]));
    if (!(foot.away.squaredNorm() < distance_ * distance_)) continue;
    ClosePoints close{{v, kNone, kNone, kNone}, 1, {1, 0, 0, 0}, foot.away, 1, false};
    for (std::size_t k = 0, next = 1; k < 3; ++k) {
      const double weight = foot.weight[static_cast<Eigen::Index>(k)];
      if (weight > 0) close.node[next] = n[k], close.weight[next++] = -weight;
    }
    close.in_wall = isInWall(close);
    scan.spots.push_back(close);
  }
}

// The first of two edges is one of the triangle; where it is the second, the other triangle finds them.
void SelfContactClose::addEdges(int triangle, int other, Scan& scan) const {
  for (const int q : edge_of_[other]) {
    if (!scan.marks.meetsEdge(q) || isFar(edges_[q], scan)) continue;
    for (const int p : edge_of_[triangle]) {
      const Edge &one = edges_[p], &two = edges_[q];
      if (p >= q || one[0] == two[0] || one[0] == two[1] || one[1] == two[0] || one[1] == two[1]) continue;
      addEdgePair(one, two, scan);
    }
  }
}

// Adds the spot where the nearest points are inside both edges: otherwise a vertex is nearer.
void SelfContactClose::addEdgePair(const Edge& one, const Edge& other, Scan& scan) const {
  const Eigen::Vector3d from = at(one[0]), to = at(other[0]);
  const Eigen::Vector3d u = at(one[1]) - from, v = at(other[1]) - to, r = from - to;
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v), across = uu * vv - uv * uv;
  if (!(across > 0)) return;
  const double s = (uv * v.dot(r) - u.dot(r) * vv) / across, t = (uu * v.dot(r) - uv * u.dot(r)) / across;
  if (!(s > 0 && s < 1 && t > 0 && t < 1)) return;
  const Eigen::Vector3d away = r + s * u - t * v;
  if (!(away.squaredNorm() < distance_ * distance_)) return;
  scan.spots.push_back(
      {{one[0], one[1], other[0], other[1]}, 2, {1 - s, s, t - 1, -t}, away, across / (uu * vv), false});
  scan.spots.back().in_wall = isInWall(scan.spots.back());
}

bool SelfContactClose::isInWall(const ClosePoints& spot) const {
  for (int i = 0; i < spot.split; ++i)
    for (std::size_t j = spot.split; j < 4; ++j)
      if (spot.node[j] >= 0 && walls_.oneWall(spot.node[i], spot.node[j])) return true;
  return false;
}

// Whether no triangle around the point opposite to a vertex is nearer.
bool SelfContactClose::isNearest(const ClosePoints& spot) const {
  if (spot.split == 2 || spot.node[3] != kNone) return true;
  const Eigen::Vector3d vertex = at(spot.node[0]);
  const double least = kEqual * spot.away.squaredNorm();
  bool nearest = true;
  rings_.visit(spot.node[1], [&](int t) {
    const auto& n = triangles_[t];
    if (!nearest || (spot.node[2] != kNone && !hasVertex(n, spot.node[2]))) return;
    nearest = triangleFoot(vertex, at(n[0]), at(n[1]), at(n[2])).away.squaredNorm() >= least;
  });
  return nearest;
}

}  // namespace vibe
