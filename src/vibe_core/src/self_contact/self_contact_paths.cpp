#include "self_contact/self_contact_paths.hpp"

#include <algorithm>
#include <limits>

#include "geometry/triangle_distance.hpp"

namespace vibe {

namespace {

constexpr int kRounds = 5;               // of shortening, before nodes that still collide are stopped in place
constexpr int kStopRounds = 200;         // rounds of stopping, before all nodes are stopped
constexpr int kCollisionSteps = 30;      // steps towards a collision
constexpr double kEnough = 1e-3;         // part of a path below which an advance is the last
constexpr double kKeptShare = 0.9;       // remaining fraction of a distance below the floor
constexpr double kLeastDistance = 1e-6;  // distance that never gets smaller: far above rounding [m]
// Distance of parts of one wall. Design choice: so small that a part without overhang does not come so near to itself
// unless its triangles degenerate, and need not be searched [m].
constexpr double kLeastDistanceInWall = 1e-5;
constexpr double kTouching = 1e-10;  // nearer parts touch from the start, and are let go [m]

using Points = std::array<Eigen::Vector3d, 4>;

Eigen::Vector3d connection(const Points& p, int split) {
  return split == 1 ? triangleFoot(p[0], p[1], p[2], p[3]).away : segmentConnection(p[0], p[1], p[2], p[3]);
}

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
    : triangles_(triangles), walls_(walls), floor_(floor) {}

bool SelfContactPaths::shorten(const std::vector<Eigen::Vector3d>& start, const std::vector<Pair>& pairs, bool stop,
                               std::vector<Eigen::Vector3d>& move) {
  start_ = &start;
  move_ = &move;
  collect(pairs);
  if (pairs_.empty()) return false;
  news_.assign(start.size(), 1);
  next_news_.assign(start.size(), 0);
  bool any = false;
  for (int round = 0; round < kRounds + kStopRounds; ++round) {
    bool shortened = false;
    for (const auto& [one, other] : pairs_)
      if ((isNews(one) || isNews(other)) && !keepsApart(one, other))
        shortened = shortenPair(one, other, stop || round >= kRounds) || shortened;
    if (!shortened) return any;
    if (!any) pairs_ = pairs;  // shorter moves may bring others together
    if (!any) dropTangled();
    any = true;
    news_.swap(next_news_);  // unchanged moves are still free of collisions
    std::fill(next_news_.begin(), next_news_.end(), char{0});
  }
  std::fill(move.begin(), move.end(), Eigen::Vector3d::Zero());
  return any;
}

void SelfContactPaths::collect(const std::vector<Pair>& pairs) {
  pairs_.clear();
  tangled_.assign(start_->size(), 0);
  for (const Pair& pair : pairs)
    if (!keepsApart(pair[0], pair[1])) pairs_.push_back(pair);
  for (const auto& [one, other] : pairs_) {
    if (!crosses(one, other)) continue;
    for (const int v : triangles_[one]) tangled_[v] = 1;
    for (const int v : triangles_[other]) tangled_[v] = 1;
  }
  dropTangled();
}

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
bool SelfContactPaths::keepsApart(int one, int other) const {
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

bool SelfContactPaths::separates(const Eigen::Vector3d& direction, int one, int other) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
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
  const double gap = floor_ * direction.norm();
  return (low[0][0] - high[1][0] > gap && low[0][1] - high[1][1] > gap) ||
         (low[1][0] - high[0][0] > gap && low[1][1] - high[0][1] > gap);
}

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

bool SelfContactPaths::isNews(int triangle) const {
  const std::array<int, 3>& n = triangles_[triangle];
  return news_[n[0]] != 0 || news_[n[1]] != 0 || news_[n[2]] != 0;
}

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
    next_news_[v] = 1;
  }
  return true;
}

bool SelfContactPaths::isOneWall(const Primitive& primitive) const {
  for (std::size_t i = 0; i < static_cast<std::size_t>(primitive.split); ++i)
    for (std::size_t j = primitive.split; j < 4; ++j)
      if (walls_.oneWall(primitive.node[i], primitive.node[j])) return true;
  return false;
}

double SelfContactPaths::freePart(const Primitive& primitive) const {
  Points at;
  for (std::size_t k = 0; k < 4; ++k) at[k] = (*start_)[primitive.node[k]];
  Eigen::Vector3d away = connection(at, primitive.split);
  double distance = away.norm();
  if (distance < kTouching) return 1;
  const double least = isOneWall(primitive) ? kLeastDistanceInWall : std::max(kLeastDistance, floor_);
  const double floor = std::min(distance, std::max(kLeastDistance, std::min(least, kKeptShare * distance)));
  double part = 0;
  for (int advance = 0; advance < kCollisionSteps; ++advance) {
    double next = 2;
    for (int i = 0; i < primitive.split; ++i)
      for (int j = primitive.split; j < 4; ++j) {
        const std::size_t p = i, q = j;
        const double closing = away.dot((*move_)[primitive.node[q]] - (*move_)[primitive.node[p]]);
        if (closing > 0) next = std::min(next, std::max(0.0, (away.dot(at[p] - at[q]) - floor * distance) / closing));
      }
    if (part + next >= 1) return 1;
    if (next < kEnough) return part;
    part += next;
    for (std::size_t k = 0; k < 4; ++k) at[k] = (*start_)[primitive.node[k]] + part * (*move_)[primitive.node[k]];
    away = connection(at, primitive.split);
    distance = away.norm();
  }
  return part;
}

}  // namespace vibe
