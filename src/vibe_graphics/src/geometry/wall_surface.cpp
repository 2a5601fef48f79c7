#include "vibe_graphics/geometry/wall_surface.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

namespace vibe::graphics {
namespace {

using Eigen::Vector3d;

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr int kRounds = 6;  // of looking around the triangle that was nearest so far

double ratio(double part, double whole) {
  return whole > 0 ? std::min(1.0, part / whole) : 0.0;
}

/// Barycentric weights of the point of a triangle that is nearest to p (Ericson 2005, Real-Time Collision Detection,
/// 5.1.5); a corner of a triangle without area.
Vector3d nearestWeight(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Vector3d ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap), d3 = ab.dot(bp), d4 = ac.dot(bp), d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const double of_c = d1 * d4 - d3 * d2, of_b = d5 * d2 - d1 * d6, of_a = d3 * d6 - d5 * d4;
  if (of_c <= 0 && d1 >= 0 && d3 <= 0) {
    const double t = ratio(d1, d1 - d3);
    return {1 - t, t, 0};
  }
  if (of_b <= 0 && d2 >= 0 && d6 <= 0) {
    const double t = ratio(d2, d2 - d6);
    return {1 - t, 0, t};
  }
  if (of_a <= 0 && d4 >= d3 && d5 >= d6) {
    const double t = ratio(d4 - d3, (d4 - d3) + (d5 - d6));
    return {0, 1 - t, t};
  }
  const double sum = of_a + of_b + of_c;
  return sum > 0 ? Vector3d(Vector3d(of_a, of_b, of_c) / sum) : Vector3d(1, 0, 0);
}

/// Whether a box and that of a triangle have nothing in common.
bool apart(const Eigen::AlignedBox3d& box, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  for (int k = 0; k < 3; ++k)
    if (std::max({a[k], b[k], c[k]}) < box.min()[k] || std::min({a[k], b[k], c[k]}) > box.max()[k]) return true;
  return false;
}

/// Part of the way from `from` to `to` at which it passes through a triangle from its inside, and the weights there.
std::optional<double> passage(const Vector3d& from, const Vector3d& to, const Vector3d& a, const Vector3d& b,
                              const Vector3d& c, Vector3d& weight) {
  const Vector3d way = to - from, ab = b - a, ac = c - a, normal = ab.cross(ac);  // outward
  const double slope = way.dot(normal);
  if (!(slope > 0)) return std::nullopt;
  const double t = (a - from).dot(normal) / slope;
  if (t < 0 || t > 1) return std::nullopt;
  const Vector3d q = from + t * way - a;
  const double square = normal.squaredNorm(), v = q.cross(ac).dot(normal) / square,
               w = ab.cross(q).dot(normal) / square;
  constexpr double kRim = -1e-9;
  if (v < kRim || w < kRim || v + w > 1 - kRim) return std::nullopt;
  weight = {1 - v - w, v, w};
  return t;
}

}  // namespace

WallSurface::WallSurface(const std::vector<std::uint32_t>& triangles, std::size_t vertex_count)
    : triangles_(triangles),
      around_(turnedAround(triangles, 3, vertex_count)),
      places_(vertex_count, Vector3d::Zero()),
      inwards_(vertex_count, Vector3d::UnitZ()) {}

bool WallSurface::move(const std::vector<MovingVertex>& vertices, const Eigen::Isometry3d& pose) {
  const bool same = vertices.size() == vertices_.size() && pose.matrix() == pose_.matrix() &&
                    std::memcmp(vertices.data(), vertices_.data(), vertices.size() * sizeof vertices[0]) == 0;
  if (same) return false;
  vertices_ = vertices;
  pose_ = pose;
  for (std::size_t v = 0; v < places_.size(); ++v) {
    places_[v] = pose * Eigen::Map<const Eigen::Vector3f>(vertices[v].position).cast<double>();
    inwards_[v] = -(pose.linear() * Eigen::Map<const Eigen::Vector3f>(vertices[v].normal).cast<double>());
  }
  return true;
}

WallPlace WallSurface::at(std::uint32_t triangle, const Vector3d& weight) const {
  WallPlace point;
  point.triangle = triangle;
  point.weight = weight;
  Vector3d inward = Vector3d::Zero();
  for (int k = 0; k < 3; ++k) {
    const std::uint32_t vertex = corners(triangle)[k];
    point.place += weight[k] * places_[vertex];
    inward += weight[k] * inwards_[vertex];
  }
  if (inward.norm() > 1e-6) point.inward = inward.normalized();
  return point;
}

void WallSurface::tryTriangle(std::uint32_t triangle, const Vector3d& place, double& distance, std::uint32_t& best,
                              Vector3d& weight) const {
  const Vector3d &a = places_[corners(triangle)[0]], &b = places_[corners(triangle)[1]],
                 &c = places_[corners(triangle)[2]];
  const Vector3d w = nearestWeight(place, a, b, c);
  const double square = (w[0] * a + w[1] * b + w[2] * c - place).squaredNorm();
  if (square < distance) distance = square, best = triangle, weight = w;
}

WallPlace WallSurface::nearestAround(std::uint32_t triangle, const Vector3d& place) const {
  double distance = kInfinite;
  Vector3d weight(1, 0, 0);
  std::uint32_t best = triangle;
  tryTriangle(triangle, place, distance, best, weight);
  if (weight.minCoeff() > 0) return at(best, weight);  // inside of it: nothing around is nearer on a smooth wall
  for (int round = 0; round < kRounds; ++round) {
    const std::uint32_t before = best;
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t vertex = corners(before)[k];
      for (const std::uint32_t* t = around_.begin(vertex); t != around_.end(vertex); ++t)
        tryTriangle(*t, place, distance, best, weight);
    }
    if (best == before || weight.minCoeff() > 0) break;
  }
  return at(best, weight);
}

std::optional<WallPlace> WallSurface::nearest(const Vector3d& place, const Vector3d& inward, double reach) const {
  double min = reach * reach;
  std::optional<std::size_t> nearest;
  for (std::size_t v = 0; v < places_.size(); ++v) {
    const double square = (places_[v] - place).squaredNorm();
    if (square >= min || inwards_[v].dot(inward) < 0 || around_.begin(v) == around_.end(v)) continue;
    min = square, nearest = v;
  }
  if (!nearest) return std::nullopt;
  return nearestAround(*around_.begin(*nearest), place);
}

WallPlace WallSurface::moved(const WallPlace& from, const Vector3d& way) const {
  return nearestAround(from.triangle, from.place + way);
}

WallPlace WallSurface::atVertex(std::uint32_t vertex) const {
  const std::uint32_t triangle = *around_.begin(vertex);
  int k = 0;
  while (corners(triangle)[k] != vertex) ++k;
  return at(triangle, Vector3d::Unit(k));
}

std::vector<std::uint32_t> WallSurface::trianglesNear(const std::vector<Vector3d>& line) const {
  Eigen::AlignedBox3d box;
  for (const Vector3d& point : line) box.extend(point);
  std::vector<std::uint32_t> near;
  for (std::uint32_t t = 0; 3 * std::size_t{t} < triangles_.size(); ++t) {
    const Vector3d &a = places_[corners(t)[0]], &b = places_[corners(t)[1]], &c = places_[corners(t)[2]];
    if (!apart(box, a, b, c)) near.push_back(t);
  }
  return near;
}

std::optional<WallPlace> WallSurface::landing(const std::vector<Vector3d>& line, double& along) const {
  const std::vector<std::uint32_t> near = trianglesNear(line);
  for (std::size_t k = 1; k < line.size(); ++k) {
    double first = kInfinite;
    std::uint32_t triangle = 0;
    Vector3d weight = Vector3d::Zero(), candidate = weight;
    Eigen::AlignedBox3d box(line[k - 1]);
    box.extend(line[k]);
    for (const std::uint32_t t : near) {
      const Vector3d &a = places_[corners(t)[0]], &b = places_[corners(t)[1]], &c = places_[corners(t)[2]];
      if (apart(box, a, b, c)) continue;
      const auto part = passage(line[k - 1], line[k], a, b, c, candidate);
      if (part && *part < first) first = *part, triangle = t, weight = candidate;
    }
    if (first > 1) continue;
    along = static_cast<double>(k - 1) + first;
    return at(triangle, weight);
  }
  return std::nullopt;
}

}  // namespace vibe::graphics
