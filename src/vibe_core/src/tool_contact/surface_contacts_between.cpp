// Contacts between the vertices of a wall: points that divide edges and triangles, and nearest points.
#include <algorithm>
#include <cmath>

#include "tool_contact/surface_contacts.hpp"

namespace vibe {

void SurfaceContacts::addBetween(const SurfacePath& path, double margin, int shape, const std::vector<char>& excluded) {
  for (const Pair& pair : pairs_) {
    const std::array<int, 3>& n = triangles_[pair.triangle];
    if (excluded[n[0]] != 0 && excluded[n[1]] != 0 && excluded[n[2]] != 0) continue;
    // A triangle through which the shape passes already gets points inside, which push it aside.
    int most = pair.approach.nearest == 0 ? policy_.touch_pierced_parts : 1;
    for (std::size_t k = 0; k < 3; ++k) {
      const double length = (path.start(n[(k + 1) % 3]) - path.start(n[k])).norm();
      // An edge has the points of its usual stretch at least, so that it has the same from step to step.
      const int usual =
          partsOf(shape, policy_.touch_usual_stretch * length_[static_cast<std::size_t>(pair.triangle)][k]);
      const int parts = std::max(usual, partsOf(shape, length));
      most = std::max(most, parts);
      const int across = neighbour_[pair.triangle][k];
      if (isDrawnIn(shape, {n[k], n[(k + 1) % 3]}, excluded)) continue;
      // An edge of two triangles in reach belongs to the first of them.
      if (parts > 1 && !(across >= 0 && pair_of_[across] >= 0 && across < pair.triangle))
        addEdge(path, margin, shape, pair, static_cast<int>(k), parts, usual == 1 ? shareOfMiddle(shape, length) : 1);
    }
    if (most > 2 && !isDrawnIn(shape, {n[0], n[1], n[2]}, excluded)) addInterior(path, margin, shape, pair, most);
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
    add({3, n, {gap.weight[0], gap.weight[1], gap.weight[2]}}, shape, 0, gap, policy_.touch_kept_between * half);
  }
}

// Vertices that touch keep the square of the distance of a point between them from the core of a shape at least at
// touching^2 - sum over edges of w_j w_k length^2, because the square of the distance from a convex set grows no faster
// than that from a point. In the middle of an even triangle the sum is length^2 / 3.
int SurfaceContacts::partsOf(int shape, double length) const {
  return std::clamp(static_cast<int>(std::ceil(length / spacing(shape))), 1, policy_.touch_most_parts);
}

double SurfaceContacts::spacing(int shape) const {
  const double radius = tool_.radius(shape), touching = radius + half_,
               least = radius + policy_.touch_kept_between * half_;
  return std::sqrt(3 * (touching * touching - least * least));
}

// The share of its distance that a contact keeps in the middle of an edge that has none at rest. It begins with what
// the vertices leave there: a point that came and went at once would take the load from the vertices, the edge would be
// shorter in the next step without it, and the wall would never come to rest.
double SurfaceContacts::shareOfMiddle(int shape, double length) const {
  const double longer = length / spacing(shape) - 1;
  return policy_.touch_kept_between +
         (1 - policy_.touch_kept_between) * std::clamp(longer / policy_.touch_fade_in, 0.0, 1.0);
}

void SurfaceContacts::addEdge(const SurfacePath& path, double margin, int shape, const Pair& pair, int edge, int parts,
                              double share) {
  const std::array<int, 3>& n = triangles_[pair.triangle];
  const int across = neighbour_[pair.triangle][static_cast<std::size_t>(edge)];
  const bool hit = pair.approach.fraction < 1 ||
                   (across >= 0 && pair_of_[across] >= 0 && pairs_[pair_of_[across]].approach.fraction < 1);
  // From the lower to the higher vertex, so that the points are the same from both sides.
  int from = n[static_cast<std::size_t>(edge)], to = n[static_cast<std::size_t>((edge + 1) % 3)];
  if (from > to) std::swap(from, to);
  for (int k = 1; k < parts; ++k) {
    const double weight = static_cast<double>(k) / parts;
    offer({2, {from, to, -1}, {1 - weight, weight, 0}}, path, shape, hit, margin, share);
  }
}

void SurfaceContacts::addInterior(const SurfacePath& path, double margin, int shape, const Pair& pair, int parts) {
  for (int i = 1; i < parts; ++i)
    for (int j = 1; i + j < parts; ++j) {
      const double u = static_cast<double>(i) / parts, v = static_cast<double>(j) / parts;
      offer({3, triangles_[pair.triangle], {1 - u - v, u, v}}, path, shape, pair.approach.fraction < 1, margin);
    }
}

}  // namespace vibe
