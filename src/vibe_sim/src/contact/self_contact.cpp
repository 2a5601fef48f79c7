#include "vibe_sim/contact/self_contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "self_contact_distance.hpp"
#include "self_contact_search.hpp"
#include "vibe_sim/error.hpp"

namespace vibe {

namespace {

constexpr double kOneWall = 2.5;         // thicknesses along the surface
constexpr double kFacingCosine = 0.3;    // of the normals of walls that meet: the next wall along a line faces this one
constexpr double kOnset = 0.05;          // strain over which contact sets in
constexpr double kStraightBelow = 0.05;  // part of the thickness under which the energy goes on straight
constexpr double kApproach = 0.4;        // part of the gap that either side may take
constexpr double kKeptGap = 0.25;        // part of the gap at detect() that a step leaves
constexpr double kParting = 0.05;        // thicknesses that nodes that part may always move
constexpr double kRange = 0.38;          // part of the least unseen distance that either side may take in a step
constexpr double kAhead = 0.15;          // thicknesses searched beyond the reach, so that the next steps need no search
// part of a triangle's height by which its nodes may move before its normal may have turned by half the angle between
// the watched cosine of the search and the facing one
constexpr double kSteady = 0.15;

/// Energy per A E t / 2 of a wall squeezed to s of its thickness, and its slope by s.
std::pair<double, double> squeeze(double s) {
  if (s >= 1 + kOnset) return {0, 0};
  const double kept = std::max(s, kStraightBelow), strain = 1 - kept;
  const double ramp = strain + kOnset;
  const double h = strain > kOnset ? strain : ramp * ramp / (4 * kOnset);
  const double h_slope = strain > kOnset ? 1 : ramp / (2 * kOnset);
  const double hencky = std::log1p(-h);
  const double slope = hencky / (1 - h) * h_slope;
  return {0.5 * hencky * hencky + slope * (s - kept), slope};
}

void check(const SurfaceMesh& rest, const std::vector<double>& thickness, double young_modulus) {
  if (rest.vertices.empty() || thickness.size() != rest.vertices.size())
    throw Error("A wall that can meet itself has " + std::to_string(rest.vertices.size()) + " vertices but " +
                std::to_string(thickness.size()) + " thicknesses; give one thickness per vertex.");
  for (std::size_t t = 0; t < rest.triangles.size(); ++t)
    for (const int v : rest.triangles[t])
      if (v < 0 || v >= static_cast<int>(rest.vertices.size()))
        throw Error("Triangle " + std::to_string(t) + " of a wall that can meet itself names vertex " +
                    std::to_string(v) + ", which does not exist; correct the mesh.");
  for (std::size_t v = 0; v < thickness.size(); ++v)
    if (!(thickness[v] > 0 && std::isfinite(thickness[v])))
      throw Error("The wall that can meet itself has thickness " + std::to_string(thickness[v]) + " m at vertex " +
                  std::to_string(v) + "; it must be above 0.");
  if (!(young_modulus > 0 && std::isfinite(young_modulus)))
    throw Error("The wall that can meet itself has a Young's modulus of " + std::to_string(young_modulus) +
                " Pa; it must be above 0.");
}

Eigen::Vector3d at(const double* positions4, int node) {
  const double* p = positions4 + 4 * static_cast<std::size_t>(node);
  return {p[0], p[1], p[2]};
}

}  // namespace

SelfContact::SelfContact(SurfaceMesh rest, std::vector<double> thickness, double young_modulus)
    : rest_(std::move(rest)), thickness_(std::move(thickness)), young_modulus_(young_modulus) {
  check(rest_, thickness_, young_modulus_);
  area_ = vertexAreas(rest_);
  least_thickness_ = *std::min_element(thickness_.begin(), thickness_.end());
  most_thickness_ = *std::max_element(thickness_.begin(), thickness_.end());
  std::vector<double> one_wall(thickness_);
  for (double& length : one_wall) length *= kOneWall;
  search_ = std::make_unique<SelfContactSearch>(rest_, one_wall);
  start_ = searched_ = rest_.vertices;
  range_.assign(thickness_.size(), std::numeric_limits<double>::infinity());
  room_.assign(thickness_.size(), 0);
}

SelfContact::~SelfContact() = default;

void SelfContact::detect(const double* x, const double* y, const double* z, double reach) {
  double moved = 0;
  const bool finite = follow(x, y, z, moved);
  pairs_.clear();
  near_.clear();
  std::fill(range_.begin(), range_.end(), kRange * (least_thickness_ + reach));
  if (!finite) {
    margin_ = -1;
    return;
  }
  moved = std::sqrt(moved);
  if (margin_ >= 0 && moved <= steady_ && margin_ - 2 * moved > reach) return;
  search(reach);
}

bool SelfContact::follow(const double* x, const double* y, const double* z, double& moved_squared) {
  double sum = 0;
  for (std::size_t i = 0; i < start_.size(); ++i) {
    start_[i] = {x[i], y[i], z[i]};
    const double moved = (start_[i] - searched_[i]).squaredNorm();
    sum += moved;
    moved_squared = std::max(moved_squared, moved);
  }
  return std::isfinite(sum);
}

void SelfContact::search(double reach) {
  ++searches_;
  searched_ = start_;
  search_->place(start_);
  steady_ = kSteady * search_->lowestHeight();
  margin_ = reach + kAhead * most_thickness_;
  search_->flagNear((1 + kOnset + kAhead) * most_thickness_ + reach);
  if (!search_->anyFlagged()) return;
  for (int i = 0; i < static_cast<int>(start_.size()); ++i)
    if (search_->flagged(i)) addPairs(i, reach);
}

double SelfContact::meanThickness(int vertex, int triangle) const {
  const auto& n = rest_.triangles[triangle];
  return 0.5 * (thickness_[vertex] + (thickness_[n[0]] + thickness_[n[1]] + thickness_[n[2]]) / 3);
}

void SelfContact::addPairs(int vertex, double reach) {
  found_[0].clear();
  found_[1].clear();
  const Eigen::Vector3d& own = search_->normal(vertex);
  const double farthest = (1 + kOnset + kAhead) * most_thickness_ + reach;
  const double watched = SelfContactSearch::kWatchedCosine * SelfContactSearch::kWatchedCosine;
  search_->visitNear(vertex, [&](int triangle) {
    // compared by squares: most triangles are left here
    const Eigen::Vector3d& area = search_->areaVector(triangle);
    const double size = area.squaredNorm(), along = own.dot(area);
    if (along > 0 && along * along > watched * size) return;
    const auto& n = rest_.triangles[triangle];
    const double height = area.dot(start_[vertex] - start_[n[0]]);
    if (height * height > farthest * farthest * size) return;
    const TriangleFoot foot = triangleFoot(start_[vertex], start_[n[0]], start_[n[1]], start_[n[2]]);
    const double distance = foot.away.norm();
    const double margin = distance - (1 + kOnset) * meanThickness(vertex, triangle);
    margin_ = std::min(margin_, margin);
    const Eigen::Vector3d normal = area.normalized();
    if (margin >= reach || own.dot(normal) >= kFacingCosine) return;
    found_[(normal - own).dot(foot.away) >= 0 ? 1 : 0].push_back({triangle, distance});
  });
  for (int side = 0; side < 2; ++side)
    if (!found_[side].empty()) addPair(vertex, 2.0 * side - 1, found_[side], reach);
}

// The nearest triangle may change within the step, among those that are less than the reach farther away. The others
// only bound how far the nodes may go.
void SelfContact::addPair(int vertex, double side, const std::vector<NearTriangle>& found, double reach) {
  const auto nearer = [](const NearTriangle& a, const NearTriangle& b) {
    return a.distance < b.distance || (a.distance == b.distance && a.triangle < b.triangle);
  };
  const NearTriangle nearest = *std::min_element(found.begin(), found.end(), nearer);
  Pair pair{vertex, side, meanThickness(vertex, nearest.triangle), 0, static_cast<int>(near_.size()), 0};
  for (const NearTriangle& candidate : found) {
    const auto& n = rest_.triangles[candidate.triangle];
    if (candidate.distance > nearest.distance + reach) {
      const double range = kRange * candidate.distance;
      range_[vertex] = std::min(range_[vertex], range);
      for (const int v : n) range_[v] = std::min(range_[v], range);
      continue;
    }
    const auto& r = rest_.vertices;
    const double at_rest = triangleFoot(r[vertex], r[n[0]], r[n[1]], r[n[2]]).away.norm();
    pair.thickness = std::min(pair.thickness, at_rest / (1 + kOnset));
    near_.push_back(candidate);
    ++pair.count;
  }
  std::sort(near_.begin() + pair.first, near_.end(), nearer);
  pair.stiffness = 0.5 * area_[vertex] * young_modulus_ * pair.thickness;
  if (pair.stiffness > 0) pairs_.push_back(pair);
}

// The triangles of a pair come by their distance at detect(): those that cannot have come near enough are left out.
double SelfContact::farthestMove(const double* positions4) const {
  double farthest = 0;
  for (std::size_t i = 0; i < start_.size(); ++i)
    farthest = std::max(farthest, (at(positions4, static_cast<int>(i)) - start_[i]).squaredNorm());
  return std::sqrt(farthest);
}

double SelfContact::evaluate(const double* positions4, float* gradient4) const {
  if (pairs_.empty()) return 0;
  const double closer = 2 * farthestMove(positions4);
  double energy = 0;
  for (const Pair& pair : pairs_) {
    const Eigen::Vector3d p = at(positions4, pair.vertex);
    TriangleFoot foot{};
    const std::array<int, 3>* nearest = nullptr;
    double least = (1 + kOnset) * pair.thickness;
    for (int k = pair.first; k < pair.first + pair.count && near_[k].distance - closer < least; ++k) {
      const auto& n = rest_.triangles[near_[k].triangle];
      const TriangleFoot other = triangleFoot(p, at(positions4, n[0]), at(positions4, n[1]), at(positions4, n[2]));
      const double distance = other.away.norm();
      if (!(distance < least)) continue;
      least = distance;
      foot = other;
      nearest = &n;
    }
    if (nearest != nullptr) energy += addSqueeze(pair, *nearest, foot, positions4, gradient4);
  }
  return energy;
}

double SelfContact::addSqueeze(const Pair& pair, const std::array<int, 3>& n, const TriangleFoot& foot,
                               const double* positions4, float* gradient4) const {
  const SignedDistance gap =
      signedDistance(foot, pair.side, at(positions4, n[0]), at(positions4, n[1]), at(positions4, n[2]));
  const auto [value, slope] = squeeze(gap.value / pair.thickness);
  const Eigen::Vector3d force = pair.stiffness / pair.thickness * slope * gap.apart;
  for (int c = 0; c < 3; ++c) {
    gradient4[4 * static_cast<std::size_t>(pair.vertex) + c] += static_cast<float>(force[c]);
    for (int k = 0; k < 3; ++k)
      gradient4[4 * static_cast<std::size_t>(n[k]) + c] -= static_cast<float>(foot.weight[k] * force[c]);
  }
  return pair.stiffness * value;
}

void SelfContact::limitMove(const double* positions4, float* move4) const {
  if (!pairs_.empty()) limitPairs(positions4, move4);
  for (std::size_t i = 0; i < start_.size(); ++i) {
    const Eigen::Vector3d moved = at(positions4, static_cast<int>(i)) - start_[i];
    float* m = move4 + 4 * i;
    const Eigen::Vector3d move(m[0], m[1], m[2]);
    double room = pairs_.empty() ? std::numeric_limits<double>::infinity() : room_[i];
    if ((moved + move).squaredNorm() > range_[i] * range_[i])
      room = std::min(room, std::max(0.0, range_[i] - moved.norm()));
    if (move.squaredNorm() <= room * room) continue;
    const auto part = static_cast<float>(room / move.norm());
    for (int k = 0; k < 3; ++k) m[k] *= part;
  }
}

void SelfContact::limitPairs(const double* positions4, const float* move4) const {
  std::fill(room_.begin(), room_.end(), std::numeric_limits<double>::infinity());
  double longest = 0;
  for (std::size_t i = 0; i < room_.size(); ++i)
    longest = std::max(longest, Eigen::Vector3d(move4[4 * i], move4[4 * i + 1], move4[4 * i + 2]).squaredNorm());
  const double unbound = 2 * farthestMove(positions4) + std::sqrt(longest) / kApproach;
  for (const Pair& pair : pairs_) {
    const Eigen::Vector3d p = at(positions4, pair.vertex);
    const double floor = kParting * pair.thickness;
    for (int k = pair.first; k < pair.first + pair.count; ++k) {
      if ((1 - kKeptGap) * near_[k].distance > unbound) break;  // the longest move is short enough for this gap
      const auto& n = rest_.triangles[near_[k].triangle];
      const Eigen::Vector3d a = at(positions4, n[0]), b = at(positions4, n[1]), c = at(positions4, n[2]);
      const SignedDistance gap = signedDistance(triangleFoot(p, a, b, c), pair.side, a, b, c);
      const double room = kApproach * std::max(0.0, gap.value - kKeptGap * near_[k].distance);
      restrict(pair.vertex, room, floor, gap.apart, move4);
      for (const int v : n) restrict(v, room, floor, -gap.apart, move4);
    }
  }
}

void SelfContact::restrict(int node, double room, double floor, const Eigen::Vector3d& apart,
                           const float* move4) const {
  if (room >= room_[node]) return;
  const float* m = move4 + 4 * static_cast<std::size_t>(node);
  const Eigen::Vector3d move(m[0], m[1], m[2]);
  if (room < floor && move.dot(apart) >= 0.5 * move.norm()) room = floor;
  room_[node] = std::min(room_[node], room);
}

}  // namespace vibe
