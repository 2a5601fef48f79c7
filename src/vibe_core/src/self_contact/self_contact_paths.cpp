#include "self_contact/self_contact_paths.hpp"

#include <algorithm>
#include <limits>

#include "geometry/triangle_distance.hpp"

namespace vibe {

namespace {

constexpr double kTouching = 1e-10;  // rounding: nearer parts touch from the start, and are let go [m]

using Points = std::array<Eigen::Vector3d, 4>;

// Shortest connection of a vertex and a triangle (split 1), or of two edges (split 2).
Eigen::Vector3d connection(const Points& p, int split) {
  return split == 1 ? triangleFoot(p[0], p[1], p[2], p[3]).away : segmentConnection(p[0], p[1], p[2], p[3]);
}

// Six times the signed volume of a tetrahedron: on which side of a plane or line a point lies.
double volume6(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c, const Eigen::Vector3d& d) {
  return (b - a).cross(c - a).dot(d - a);
}

bool piercesTriangle(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Eigen::Vector3d& a,
                     const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  if (volume6(a, b, c, p) * volume6(a, b, c, q) >= 0) return false;
  const double ab = volume6(p, q, a, b), bc = volume6(p, q, b, c), ca = volume6(p, q, c, a);
  return (ab > 0 && bc > 0 && ca > 0) || (ab < 0 && bc < 0 && ca < 0);
}

}  // namespace

SelfContactPaths::SelfContactPaths(const std::vector<std::array<int, 3>>& triangles, const SurfaceWalls& walls,
                                   double floor)
    : policy_(stepPolicy()), triangles_(triangles), walls_(walls), floor_(floor) {}

bool SelfContactPaths::shorten(const std::vector<Eigen::Vector3d>& start, const std::vector<Pair>& pairs, bool stop,
                               std::vector<Eigen::Vector3d>& move) {
  start_ = &start;
  move_ = &move;
  collect(pairs);
  if (pairs_.empty()) return false;
  shortened_.assign(start.size(), 1);
  next_shortened_.assign(start.size(), 0);
  bool any = false;
  for (int round = 0; round < policy_.path_rounds + policy_.path_stop_rounds; ++round) {
    // Shortening by parts may go on for ever where nodes are stuck between walls; stopping in place does not.
    const bool in_place = stop || round >= policy_.path_rounds;
    bool shortened = false;
    for (const auto& [one, other] : pairs_)
      if ((isShortened(one) || isShortened(other)) && !keepsSeparate(one, other))
        shortened = shortenPair(one, other, in_place) || shortened;
    if (!shortened) return any;
    // The first collisions are looked for among pairs whose whole paths meet; shorter moves may bring others together.
    if (!any) pairs_ = pairs;
    if (!any) dropTangled();
    any = true;
    // Pairs whose moves have not changed are still free of collisions.
    shortened_.swap(next_shortened_);
    std::fill(next_shortened_.begin(), next_shortened_.end(), char{0});
  }
  std::fill(move.begin(), move.end(), Eigen::Vector3d::Zero());
  return any;
}

// Keeps the pairs that may meet, but for those of triangles that cross already.
void SelfContactPaths::collect(const std::vector<Pair>& pairs) {
  pairs_.clear();
  tangled_.assign(start_->size(), 0);
  for (const Pair& pair : pairs)
    if (!keepsSeparate(pair[0], pair[1])) pairs_.push_back(pair);
  for (const auto& [one, other] : pairs_) {
    if (!crosses(one, other)) continue;
    for (const int v : triangles_[one]) tangled_[v] = 1;
    for (const int v : triangles_[other]) tangled_[v] = 1;
  }
  dropTangled();
}

// Where triangles cross at the start, they and their neighbours may pass each other, so that they can come apart.
void SelfContactPaths::dropTangled() {
  const auto tangled = [this](int t) {
    return tangled_[triangles_[t][0]] != 0 || tangled_[triangles_[t][1]] != 0 || tangled_[triangles_[t][2]] != 0;
  };
  pairs_.erase(std::remove_if(pairs_.begin(), pairs_.end(),
                              [&](const Pair& pair) { return tangled(pair[0]) && tangled(pair[1]); }),
               pairs_.end());
}

// Two triangles that are separated at the start and at the end of their straight paths by a plane with the same normal
// stay apart: the distance along the normal is a concave function of time.
bool SelfContactPaths::keepsSeparate(int one, int other) const {
  const std::array<int, 3>&a = triangles_[one], &b = triangles_[other];
  const std::vector<Eigen::Vector3d>& at = *start_;
  const Eigen::Vector3d between = (at[a[0]] + at[a[1]] + at[a[2]]) - (at[b[0]] + at[b[1]] + at[b[2]]);
  return separates(between, one, other) || separates(normal(one), one, other) || separates(normal(other), one, other);
}

Eigen::Vector3d SelfContactPaths::normal(int triangle) const {
  const std::array<int, 3>& t = triangles_[triangle];
  const Eigen::Vector3d& a = (*start_)[t[0]];
  return ((*start_)[t[1]] - a).cross((*start_)[t[2]] - a);
}

// Whether two triangles have a gap along a direction, above the floor, at the start and at the end of their paths.
bool SelfContactPaths::separates(const Eigen::Vector3d& direction, int one, int other) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  // Extents of both triangles [side] along the direction, at the start and at the end [moment].
  double low[2][2] = {{kInfinity, kInfinity}, {kInfinity, kInfinity}};
  double high[2][2] = {{-kInfinity, -kInfinity}, {-kInfinity, -kInfinity}};
  for (int side = 0; side < 2; ++side)
    for (const int v : triangles_[side == 0 ? one : other]) {
      const double from = direction.dot((*start_)[v]), to = from + direction.dot((*move_)[v]);
      low[side][0] = std::min(low[side][0], from);
      high[side][0] = std::max(high[side][0], from);
      low[side][1] = std::min(low[side][1], to);
      high[side][1] = std::max(high[side][1], to);
    }
  // The direction is not unit: that spares a root per pair that is far apart.
  const double gap = floor_ * direction.norm();
  return (low[0][0] - high[1][0] > gap && low[0][1] - high[1][1] > gap) ||
         (low[1][0] - high[0][0] > gap && low[1][1] - high[0][1] > gap);
}

// Two triangles cross where an edge of one pierces the other.
bool SelfContactPaths::crosses(int one, int other) const {
  const std::vector<Eigen::Vector3d>& at = *start_;
  const auto anyEdge = [&](const std::array<int, 3>& edges, const std::array<int, 3>& face) {
    for (int k = 0; k < 3; ++k) {
      const int p = edges[k], q = edges[(k + 1) % 3];
      if (!hasVertex(face, p) && !hasVertex(face, q) &&
          piercesTriangle(at[p], at[q], at[face[0]], at[face[1]], at[face[2]]))
        return true;
    }
    return false;
  };
  const std::array<int, 3>&a = triangles_[one], &b = triangles_[other];
  return anyEdge(a, b) || anyEdge(b, a);
}

bool SelfContactPaths::isShortened(int triangle) const {
  const std::array<int, 3>& n = triangles_[triangle];
  return shortened_[n[0]] != 0 || shortened_[n[1]] != 0 || shortened_[n[2]] != 0;
}

// Triangles touch first at a vertex of one of them or between two edges; those that they share do not count.
bool SelfContactPaths::shortenPair(int one, int other, bool stop) {
  const std::array<int, 3>&a = triangles_[one], &b = triangles_[other];
  bool any = false;
  for (int k = 0; k < 3; ++k) {
    if (!hasVertex(b, a[k])) any = shortenPrimitive({{a[k], b[0], b[1], b[2]}, 1}, stop) || any;
    if (!hasVertex(a, b[k])) any = shortenPrimitive({{b[k], a[0], a[1], a[2]}, 1}, stop) || any;
    const int p = a[k], q = a[(k + 1) % 3];
    for (int l = 0; l < 3; ++l) {
      const int r = b[l], s = b[(l + 1) % 3];
      if (p != r && p != s && q != r && q != s) any = shortenPrimitive({{p, q, r, s}, 2}, stop) || any;
    }
  }
  return any;
}

bool SelfContactPaths::shortenPrimitive(const Primitive& primitive, bool stop) {
  const double part = freePart(primitive);
  if (part >= 1) return false;
  for (const int v : primitive.node) {
    (*move_)[v] *= stop ? 0 : part;
    next_shortened_[v] = 1;
  }
  return true;
}

bool SelfContactPaths::isOneWall(const Primitive& primitive) const {
  for (std::size_t i = 0; i < static_cast<std::size_t>(primitive.split); ++i)
    for (std::size_t j = primitive.split; j < 4; ++j)
      if (walls_.oneWall(primitive.node[i], primitive.node[j])) return true;
  return false;
}

// The part of the ways up to which a primitive keeps its floor, by conservative advancement, equation in the header.
double SelfContactPaths::freePart(const Primitive& primitive) const {
  Points at;
  for (std::size_t k = 0; k < 4; ++k) at[k] = (*start_)[primitive.node[k]];
  Eigen::Vector3d away = connection(at, primitive.split);
  double distance = away.norm();
  if (distance < kTouching) return 1;
  // What is nearer than the floor already keeps a share of its distance, and so never meets.
  const double smallest = policy_.path_least_distance;
  const double least = isOneWall(primitive) ? policy_.path_floor_in_wall : std::max(smallest, floor_);
  const double floor = std::min(distance, std::max(smallest, std::min(least, policy_.path_kept_share * distance)));
  double part = 0;
  for (int advance = 0; advance < policy_.path_advances; ++advance) {
    // The distance falls no faster than that of any two nodes along the present connection; 2 is beyond the whole way.
    double next = 2;
    for (int i = 0; i < primitive.split; ++i)
      for (int j = primitive.split; j < 4; ++j) {
        const std::size_t p = i, q = j;
        const double closing = away.dot((*move_)[primitive.node[q]] - (*move_)[primitive.node[p]]);
        if (closing > 0) next = std::min(next, std::max(0.0, (away.dot(at[p] - at[q]) - floor * distance) / closing));
      }
    if (part + next >= 1) return 1;
    if (next < policy_.path_least_advance) return part;
    part += next;
    for (std::size_t k = 0; k < 4; ++k) at[k] = (*start_)[primitive.node[k]] + part * (*move_)[primitive.node[k]];
    away = connection(at, primitive.split);
    distance = away.norm();
  }
  return part;
}

}  // namespace vibe
