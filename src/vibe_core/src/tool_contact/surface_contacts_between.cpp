// Contacts between the vertices of a wall: points that divide edges and triangles, and nearest points.
#include <algorithm>
#include <cmath>

#include "tool_contact/surface_contacts.hpp"

namespace vibe {

void SurfaceContacts::addBetween(const SurfacePath& path, double margin, int shape, const std::vector<char>& excluded) {
  for (const Pair& pair : pairs_) {
    const std::array<int, 3>& n = triangles_[pair.triangle];
    if (excluded[n[0]] != 0 && excluded[n[1]] != 0 && excluded[n[2]] != 0) continue;
    const std::array<double, 3>& rest = length_[static_cast<std::size_t>(pair.triangle)];
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double length = (path.start(n[(k + 1) % 3]) - path.start(n[k])).norm();
      longest = std::max(longest, length);
      const int across = neighbour_[pair.triangle][k];
      if (isDrawnIn(shape, {n[k], n[(k + 1) % 3]}, excluded)) continue;
      // An edge of two triangles in reach belongs to the first of them.
      if (across >= 0 && pair_of_[across] >= 0 && across < pair.triangle) continue;
      const double half = 0.5 * (half_thickness_[n[k]] + half_thickness_[n[(k + 1) % 3]]);
      addEdge(path, margin, shape, pair, static_cast<int>(k), divide(rest[k], length, spacing(shape, half)));
    }
    if (isDrawnIn(shape, {n[0], n[1], n[2]}, excluded)) continue;
    const double half = halfThickness(n, Eigen::Vector3d::Constant(1. / 3));
    Division division = divide(*std::max_element(rest.begin(), rest.end()), longest, spacing(shape, half));
    // A triangle through which the shape passes already gets points inside, which push it aside.
    if (pair.approach.nearest == 0 && division.parts < policy_.touch_pierced_parts)
      division = {policy_.touch_pierced_parts, 1};
    addInterior(path, margin, shape, pair, division);
  }
}

// Points between vertices need not be where the wall is nearest: what they leave is closed by the nearest points.
void SurfaceContacts::addNearest(int shape, const std::vector<char>& excluded) {
  for (const Pair& pair : pairs_) {
    const TriangleGap& gap = pair.approach.start;
    const std::array<int, 3>& n = triangles_[pair.triangle];
    const double half = halfThickness(n, gap.weight);
    if (gap.distance - tool_.radius(shape) > policy_.touch_nearest * half) continue;
    if (isDrawnIn(shape, {n[0], n[1], n[2]}, excluded)) continue;
    // A point of vertices that are held or fixed cannot move.
    double yielding = 0;
    for (std::size_t k = 0; k < 3; ++k)
      if (excluded[n[k]] == 0) yielding += gap.weight[static_cast<int>(k)];
    if (yielding < policy_.touch_least_yielding) continue;
    add({3, n, {gap.weight[0], gap.weight[1], gap.weight[2]}}, shape, 0, gap, policy_.touch_kept_between * half, true);
  }
}

// Points that touch keep the square of the distance of a point between them from the core of a shape at least at
// touching^2 - sum over edges of w_j w_k length^2, because the square of the distance from a convex set grows no faster
// than that from a point. In the middle of an even triangle the sum is length^2 / 3.
// @param half  of the wall there [m]
// @returns distance of points that keep what is between them [m]
double SurfaceContacts::spacing(int shape, double half) const {
  const double radius = tool_.radius(shape), touching = radius + half,
               least = radius + policy_.touch_kept_between * half;
  return std::sqrt(3 * (touching * touching - least * least));
}

// A point that came and went at once would take the load from its neighbours, the edge would be shorter in the next
// step without it, and the wall would never come to rest. So the points that an edge has at rest stay, and where it is
// too long each of its parts is halved. What halves a part begins with what the others leave there anyway, and keeps
// its whole distance before its own parts are halved.
// @param rest, length  of an edge, at rest and now [m]
SurfaceContacts::Division SurfaceContacts::divide(double rest, double length, double spacing) const {
  const double kept = policy_.touch_kept_between;
  Division division;
  division.parts = std::clamp(static_cast<int>(std::ceil(policy_.touch_usual_stretch * rest / spacing)), 1,
                              policy_.touch_most_parts);
  while (length > division.parts * spacing && division.parts < policy_.touch_most_parts) {
    const double longer = length / (division.parts * spacing) - 1;
    division.share = kept + (1 - kept) * std::min(longer / policy_.touch_fade_in, 1.0);
    division.parts *= 2;
  }
  return division;
}

void SurfaceContacts::addEdge(const SurfacePath& path, double margin, int shape, const Pair& pair, int edge,
                              const Division& division) {
  const std::array<int, 3>& n = triangles_[pair.triangle];
  const int across = neighbour_[pair.triangle][static_cast<std::size_t>(edge)];
  const bool hit = pair.approach.fraction < 1 ||
                   (across >= 0 && pair_of_[across] >= 0 && pairs_[pair_of_[across]].approach.fraction < 1);
  // From the lower to the higher vertex, so that the points are the same from both sides.
  int from = n[static_cast<std::size_t>(edge)], to = n[static_cast<std::size_t>((edge + 1) % 3)];
  if (from > to) std::swap(from, to);
  for (int k = 1; k < division.parts; ++k) {
    const double weight = static_cast<double>(k) / division.parts;
    offer({2, {from, to, -1}, {1 - weight, weight, 0}}, path, shape, hit, margin, k % 2 == 0 ? 1 : division.share);
  }
}

void SurfaceContacts::addInterior(const SurfacePath& path, double margin, int shape, const Pair& pair,
                                  const Division& division) {
  const int parts = division.parts;
  for (int i = 1; i < parts; ++i)
    for (int j = 1; i + j < parts; ++j) {
      const double u = static_cast<double>(i) / parts, v = static_cast<double>(j) / parts;
      const bool halves = i % 2 != 0 || j % 2 != 0;
      offer({3, triangles_[pair.triangle], {1 - u - v, u, v}}, path, shape, pair.approach.fraction < 1, margin,
            halves ? division.share : 1);
    }
}

}  // namespace vibe
