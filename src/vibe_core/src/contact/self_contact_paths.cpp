#include "contact/self_contact_paths.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "contact/self_contact_distance.hpp"

namespace vibe {

namespace {

constexpr int kRounds = 5;          // of shortening, before nodes that still collide are stopped in place
constexpr int kStops = 200;         // rounds of stopping, before all nodes are stopped
constexpr int kAdvances = 100;      // steps towards a collision
constexpr double kKept = 0.1;       // remaining fraction of the distance above the floor
constexpr double kNearest = 0.9;    // remaining fraction of a distance below the floor
constexpr double kTouching = 1e-9;  // two parts that are nearer than this are already in contact [m]

using Points = std::array<Eigen::Vector3d, 4>;

double distanceOf(const Points& p, int split) {
  return split == 1 ? triangleFoot(p[0], p[1], p[2], p[3]).away.norm() : segmentDistance(p[0], p[1], p[2], p[3]);
}

std::pair<double, double> rangeAlong(const Eigen::Vector3d& direction, const std::array<int, 3>& triangle,
                                     const std::vector<Eigen::Vector3d>& at) {
  const double a = direction.dot(at[triangle[0]]), b = direction.dot(at[triangle[1]]),
               c = direction.dot(at[triangle[2]]);
  return {std::min({a, b, c}), std::max({a, b, c})};
}

}  // namespace

SelfContactPaths::SelfContactPaths(const std::vector<std::array<int, 3>>& triangles, const SelfContactSearch& search,
                                   double floor)
    : triangles_(triangles), search_(search), floor_(floor) {}

bool SelfContactPaths::shorten(const std::vector<Eigen::Vector3d>& start, const std::vector<Approach>& approaches,
                               std::vector<Eigen::Vector3d>& move) {
  start_ = &start;
  move_ = &move;
  news_.assign(start.size(), 1);
  next_news_.assign(start.size(), 0);
  bool any = false;
  for (int round = 0; round < kRounds + kStops; ++round) {
    collect(approaches);
    bool shortened = false;
    for (const auto& [one, other] : pairs_) shortened = shortenPair(one, other, round >= kRounds) || shortened;
    if (!shortened) return any;
    any = true;
    news_.swap(next_news_);  // unchanged moves are still free of collisions
    std::fill(next_news_.begin(), next_news_.end(), char{0});
  }
  std::fill(move.begin(), move.end(), Eigen::Vector3d::Zero());
  return any;
}

// Two triangles that are separated at the start and at the end of their straight paths by a plane perpendicular to the
// shortest connection between them stay apart: the distance along its normal is a concave function of time.
void SelfContactPaths::collect(const std::vector<Approach>& approaches) {
  pairs_.clear();
  for (const Approach& approach : approaches) {
    const std::array<int, 3>& other = triangles_[approach.near.triangle];
    const bool news = isNews(approach.near.triangle);
    const Eigen::Vector3d normal = approach.away.normalized();
    const double high = rangeAlong(normal, other, *start_).second;
    double end = -std::numeric_limits<double>::infinity();
    for (const int v : other) end = std::max(end, normal.dot((*start_)[v] + (*move_)[v]));
    search_.visitRing(approach.near.vertex, [&](int t) {
      if (!news && !isNews(t)) return;
      if (rangeAlong(normal, triangles_[t], *start_).first - high > floor_) {
        double low = std::numeric_limits<double>::infinity();
        for (const int v : triangles_[t]) low = std::min(low, normal.dot((*start_)[v] + (*move_)[v]));
        if (low - end > floor_) return;
      }
      pairs_.emplace_back(std::min(t, approach.near.triangle), std::max(t, approach.near.triangle));
    });
  }
  std::sort(pairs_.begin(), pairs_.end());
  pairs_.erase(std::unique(pairs_.begin(), pairs_.end()), pairs_.end());
}

bool SelfContactPaths::isNews(int triangle) const {
  const std::array<int, 3>& n = triangles_[triangle];
  return news_[n[0]] != 0 || news_[n[1]] != 0 || news_[n[2]] != 0;
}

bool SelfContactPaths::shortenPair(int one, int other, bool stop) {
  const std::array<int, 3>&a = triangles_[one], &b = triangles_[other];
  if (search_.sameWall(a, b)) return false;
  bool any = false;
  for (int k = 0; k < 3; ++k) {
    any = shortenPrimitive({{a[k], b[0], b[1], b[2]}, 1}, stop) || any;
    any = shortenPrimitive({{b[k], a[0], a[1], a[2]}, 1}, stop) || any;
    for (int l = 0; l < 3; ++l) any = shortenPrimitive({{a[k], a[(k + 1) % 3], b[l], b[(l + 1) % 3]}, 2}, stop) || any;
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

// Additive continuous collision detection (Li, Kaufman, Jiang: Codimensional Incremental Potential Contact, 2021):
// advances by steps that the distance permits until it is used up.
double SelfContactPaths::freePart(const Primitive& primitive) const {
  Points at, move;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < 4; ++k) {
    at[k] = (*start_)[primitive.node[k]];
    move[k] = (*move_)[primitive.node[k]];
    mean += 0.25 * move[k];
  }
  double longest[2] = {0, 0};
  for (int k = 0; k < 4; ++k)
    longest[k < primitive.split ? 0 : 1] =
        std::max(longest[k < primitive.split ? 0 : 1], (move[static_cast<std::size_t>(k)] - mean).norm());
  const double speed = longest[0] + longest[1];
  if (speed == 0) return 1;
  double distance = distanceOf(at, primitive.split);
  const double floor = std::min(floor_, kNearest * distance);
  if (distance - speed > floor || distance < kTouching) return 1;
  const double kept = kKept * (distance - floor);
  double part = 0;
  for (int advance = 0; advance < kAdvances; ++advance) {
    const double next = (1 - kKept) * (distance - floor) / speed;
    if (part + next >= 1) return 1;
    for (std::size_t k = 0; k < 4; ++k) at[k] += next * (move[k] - mean);
    distance = distanceOf(at, primitive.split);
    if (advance > 0 && distance - floor < kept) return part;
    part += next;
  }
  return part;
}

}  // namespace vibe
