#include "tool_contact/surface_contacts.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

namespace vibe {

namespace {

// Points between vertices are as dense as it takes to keep the mid-surface farther from the shape than this share of
// half the wall while they touch. Design choice: far from crossing, and a scope in a stomach of a few thousand
// particles needs none [1].
constexpr double kKeptBetweenVertices = 0.25;
// Where a triangle is nearer than this share of half the wall, its nearest point is a contact as well, which keeps
// kKeptBetweenVertices. Design choice: what points between vertices are meant to keep, and more than what the guard of
// the tool does (tool_guard) [1].
constexpr double kNearestPoint = 0.5;
// Least weight of vertices that can give way at such a point [1].
constexpr double kGivesWay = 0.1;
// Stretch of the wall for which that is so at least, so that edges have the same points from step to step; points are
// added where the wall is stretched more. Design choice: that of an insufflated stomach [1].
constexpr double kUsualStretch = 1.15;
// How much longer than where it begins an edge is until an added point in its middle keeps the whole distance. A point
// that came and went at once would take the load from the vertices, the edge would be shorter in the next step without
// it, and the wall would never come to rest. Design choice: the edge follows a point's distance by less than a third;
// with half of this, walls still trembled [1].
constexpr double kFadeIn = 0.5;
// Parts of a triangle through which a shape already passes, because it was put there: points within are pushed aside.
constexpr int kPierced = 4;
// Most parts into which an edge is divided. Design choice: a needle of half a millimetre in a mesh of 10 mm.
constexpr int kMaxParts = 8;
// Depth below the surface of a shape, over its radius, up to which a path is followed to take a normal; the axis itself
// has none. Design choice [1].
constexpr double kDeepest = 0.5;
// The same where a shape has no radius, over half the thickness of the wall [1].
constexpr double kDeepestInWall = 0.5;
// Cosine of the angle between normals of two shapes at one place above which the deeper contact replaces the other.
// Design choice: 45 degrees [1].
constexpr double kSameSide = 0.7;
// Cosine of the angle between the normals at the two ends of a step up to which one between them is taken. Design
// choice: 25 degrees, which a tip reaches at 0.2 m/s; beyond, the distance is far from linear along the way [1].
constexpr double kAlong = 0.9;
constexpr double kBuried = 1e-6;  // depth of a place of one shape within another from which it cannot touch [m]

std::vector<std::array<int, 3>> neighbours(const std::vector<std::array<int, 3>>& triangles) {
  std::map<std::pair<int, int>, int> of_edge;  // directed
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) of_edge[{triangles[t][k], triangles[t][(k + 1) % 3]}] = static_cast<int>(t);
  std::vector<std::array<int, 3>> result(triangles.size(), {-1, -1, -1});
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto found = of_edge.find({triangles[t][(k + 1) % 3], triangles[t][k]});
      if (found != of_edge.end()) result[t][k] = found->second;
    }
  return result;
}

// the vertices, ascending; absent ones first
std::array<int, 3> keyOf(const SurfacePoint& point) {
  auto [a, b, c] = point.node;
  if (a > b) std::swap(a, b);
  if (b > c) std::swap(b, c);
  if (a > b) std::swap(a, b);
  return {a, b, c};
}

// Each is at a place of the wall that the other shares.
bool isCoveredBy(const SurfaceContact& deeper, const SurfaceContact& contact) {
  return deeper.distance < 0 || deeper.normal.dot(contact.normal) > kSameSide;
}

bool isSamePlace(const SurfacePoint& one, const SurfacePoint& other) {
  return one.count == other.count && one.node == other.node && one.weight == other.weight;
}

}  // namespace

std::vector<char> passableVertices(const Organ& organ) {
  std::vector<char> passable;
  for (const End end : organ.end) passable.push_back(end != End::None ? 1 : 0);
  return passable;
}

SurfaceContacts::SurfaceContacts(const ToolModel& tool, const SurfaceMesh& surface,
                                 const std::vector<double>& thickness, const std::vector<char>& passable)
    : tool_(tool),
      on_tip_(shapesOnTip(tool)),
      near_triangles_(surface, passable),
      triangles_(near_triangles_.triangles()),
      neighbour_(neighbours(triangles_)) {
  for (const double t : thickness) {
    half_thickness_.push_back(0.5 * t);
    max_half_thickness_ = std::max(max_half_thickness_, 0.5 * t);
  }
  half_ = std::accumulate(half_thickness_.begin(), half_thickness_.end(), 0.0) / static_cast<double>(thickness.size());
  for (const std::array<int, 3>& n : triangles_) {
    std::array<double, 3> length{};
    for (std::size_t k = 0; k < 3; ++k) length[k] = (surface.vertices[n[(k + 1) % 3]] - surface.vertices[n[k]]).norm();
    length_.push_back(length);
  }
  hit_.resize(thickness.size());
  stamp_.resize(thickness.size());
  pair_of_.assign(triangles_.size(), -1);
}

double SurfaceContacts::halfThickness(const std::array<int, 3>& node, const Eigen::Vector3d& weight) const {
  return weight[0] * half_thickness_[node[0]] + weight[1] * half_thickness_[node[1]] +
         weight[2] * half_thickness_[node[2]];
}

const std::vector<SurfaceContact>& SurfaceContacts::find(const std::vector<Eigen::Isometry3d>& start,
                                                         const std::vector<Eigen::Isometry3d>& end,
                                                         const SurfacePath& path, double margin,
                                                         const std::vector<char>& excluded, double when) {
  contacts_.clear(), kept_.clear();
  when_ = when;
  tool_.place(start, end);
  near_triangles_.find(tool_, path, max_half_thickness_ + margin, near_);
  for (std::size_t first = 0, last = 0; first < near_.size(); first = last) {
    const int shape = near_[first].shape;
    while (last < near_.size() && near_[last].shape == shape) ++last;
    followPairs(path, margin, first, last);
    addVertices(path, margin, shape, excluded);
    addBetween(path, margin, shape, excluded);
    addNearest(shape, excluded);
    for (const Pair& pair : pairs_) pair_of_[pair.triangle] = -1;
  }
  removeDuplicates();
  return kept_;
}

// pairs that come within reach, and the vertices of their triangles
void SurfaceContacts::followPairs(const SurfacePath& path, double margin, std::size_t first, std::size_t last) {
  pairs_.clear(), vertices_.clear();
  ++count_;
  fraction_ = 1;
  for (std::size_t k = first; k < last; ++k) {
    const auto [shape, t] = near_[k];
    const std::array<int, 3>& n = triangles_[t];
    const double radius = tool_.radius(shape);
    const double floor =
        std::max(kDeepest * radius, kDeepestInWall * halfThickness(n, Eigen::Vector3d::Constant(1. / 3)));
    if (staysApart(tool_, shape, path, n, floor, radius + max_half_thickness_ + margin)) continue;
    const Pair pair{t, approach(tool_, shape, path, n, floor)};
    if (pair.approach.fraction == 1 && pair.approach.nearest - radius - max_half_thickness_ > margin) continue;
    pair_of_[t] = static_cast<int>(pairs_.size());
    pairs_.push_back(pair);
    for (const int v : n) {
      if (stamp_[v] != count_) stamp_[v] = count_, hit_[v] = 0, vertices_.push_back(v);
      if (pair.approach.fraction < 1) hit_[v] = 1;
    }
    fraction_ = std::min(fraction_, pair.approach.fraction);
  }
  std::sort(vertices_.begin(), vertices_.end());
}

void SurfaceContacts::addVertices(const SurfacePath& path, double margin, int shape,
                                  const std::vector<char>& excluded) {
  for (const int v : vertices_)
    if (excluded[v] == 0) offer(SurfacePoint::ofNode(v), path, shape, hit_[v] != 0, margin);
}

bool SurfaceContacts::isDrawnIn(int shape, std::initializer_list<int> vertices,
                                const std::vector<char>& excluded) const {
  return on_tip_[shape] != 0 &&
         std::any_of(vertices.begin(), vertices.end(), [&](int vertex) { return excluded[vertex] == kHeld; });
}

void SurfaceContacts::addBetween(const SurfacePath& path, double margin, int shape, const std::vector<char>& excluded) {
  for (const Pair& pair : pairs_) {
    const std::array<int, 3>& n = triangles_[pair.triangle];
    if (excluded[n[0]] != 0 && excluded[n[1]] != 0 && excluded[n[2]] != 0) continue;
    int most = pair.approach.nearest == 0 ? kPierced : 1;
    for (std::size_t k = 0; k < 3; ++k) {
      const double length = (path.start(n[(k + 1) % 3]) - path.start(n[k])).norm();
      const int usual = partsOf(shape, kUsualStretch * length_[static_cast<std::size_t>(pair.triangle)][k]);
      const int parts = std::max(usual, partsOf(shape, length));
      most = std::max(most, parts);
      const int across = neighbour_[pair.triangle][k];
      if (isDrawnIn(shape, {n[k], n[(k + 1) % 3]}, excluded)) continue;
      if (parts > 1 && !(across >= 0 && pair_of_[across] >= 0 && across < pair.triangle))
        addEdge(path, margin, shape, pair, static_cast<int>(k), parts, usual == 1 ? shareOfMiddle(shape, length) : 1);
    }
    if (most > 2 && !isDrawnIn(shape, {n[0], n[1], n[2]}, excluded)) addInterior(path, margin, shape, pair, most);
  }
}

// What the points leave: none of them is where the wall is nearest.
void SurfaceContacts::addNearest(int shape, const std::vector<char>& excluded) {
  for (const Pair& pair : pairs_) {
    const TriangleGap& gap = pair.approach.start;
    const std::array<int, 3>& n = triangles_[pair.triangle];
    const double half = halfThickness(n, gap.weight);
    if (gap.distance - tool_.radius(shape) > kNearestPoint * half) continue;
    if (isDrawnIn(shape, {n[0], n[1], n[2]}, excluded)) continue;
    double gives_way = 0;
    for (std::size_t k = 0; k < 3; ++k)
      if (excluded[n[k]] == 0) gives_way += gap.weight[static_cast<int>(k)];
    if (gives_way < kGivesWay) continue;
    add({3, n, {gap.weight[0], gap.weight[1], gap.weight[2]}}, shape, 0, gap, kKeptBetweenVertices * half);
  }
}

// Vertices that touch keep the square of the distance of a point between them from the core of a shape at least at
// touching^2 - sum over edges of w_j w_k length^2, because the square of the distance from a convex set grows no faster
// than that from a point. In the middle of an even triangle the sum is length^2 / 3.
int SurfaceContacts::partsOf(int shape, double length) const {
  return std::clamp(static_cast<int>(std::ceil(length / spacing(shape))), 1, kMaxParts);
}

double SurfaceContacts::spacing(int shape) const {
  const double radius = tool_.radius(shape), touching = radius + half_, least = radius + kKeptBetweenVertices * half_;
  return std::sqrt(3 * (touching * touching - least * least));
}

// Of the distance that a contact keeps, in the middle of an edge that has none at rest. It begins with what the
// vertices leave there.
double SurfaceContacts::shareOfMiddle(int shape, double length) const {
  const double longer = length / spacing(shape) - 1;
  return kKeptBetweenVertices + (1 - kKeptBetweenVertices) * std::clamp(longer / kFadeIn, 0.0, 1.0);
}

void SurfaceContacts::addEdge(const SurfacePath& path, double margin, int shape, const Pair& pair, int edge, int parts,
                              double share) {
  const std::array<int, 3>& n = triangles_[pair.triangle];
  const int across = neighbour_[pair.triangle][static_cast<std::size_t>(edge)];
  const bool hit = pair.approach.fraction < 1 ||
                   (across >= 0 && pair_of_[across] >= 0 && pairs_[pair_of_[across]].approach.fraction < 1);
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

// @param hit    the shape would pass through the wall there
// @param share  of the distance that it keeps
void SurfaceContacts::offer(const SurfacePoint& point, const SurfacePath& path, int shape, bool hit, double margin,
                            double share) {
  const auto placeAt = [&](double when) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < static_cast<std::size_t>(point.count); ++k)
      sum += point.weight[k] * path.at(point.node[k], when);
    return sum;
  };
  double clearance = 0;
  for (std::size_t k = 0; k < static_cast<std::size_t>(point.count); ++k)
    clearance += share * point.weight[k] * half_thickness_[point.node[k]];
  const auto gapAt = [&](double when) { return tool_.gap(shape, when, placeAt(when)); };
  const double reach = tool_.radius(shape) + clearance + margin;
  double fraction = fraction_;
  TriangleGap gap = gapAt(fraction);
  if (!hit && gap.distance > reach) {  // it leaves; yet it may come back
    gap = gapAt(fraction = 0);
    if (gap.distance > reach) return;
  }
  if (fraction < 1)
    add(point, shape, fraction, gap, clearance);
  else
    addAlong(point, shape, placeAt(0), placeAt(1), gap, clearance);
}

// A contact acts along the normal that the point has at the moment at which the forces of the step act, on its straight
// way as seen from the shape. Where the wall resists at one moment and the shape pushes along the normal of another, a
// tip that slides is driven or braked by the angle between them. The distance is that at the end.
// @param start, end  place of the point
// @param gap         at the end
void SurfaceContacts::addAlong(const SurfacePoint& point, int shape, const Eigen::Vector3d& start,
                               const Eigen::Vector3d& end, const TriangleGap& gap, double clearance) {
  const TriangleGap before = tool_.gap(shape, 0, start);
  const Eigen::Vector3d from = tool_.directionAtEnd(shape, 0, before.normal);
  if (!(from.dot(gap.normal) > kAlong)) return add(point, shape, 1, gap, clearance);
  SurfaceContact contact;
  contact.point = point;
  contact.shape = shape;
  contact.clearance = clearance;
  contact.distance = gap.distance - tool_.radius(shape);
  contact.normal = ((1 - when_) * before.distance * from + when_ * gap.distance * gap.normal).normalized();
  contact.tool_point = end - contact.distance * contact.normal;
  if (!isBuried(contact)) contacts_.push_back(contact);
}

void SurfaceContacts::add(const SurfacePoint& point, int shape, double fraction, const TriangleGap& gap,
                          double clearance) {
  if (gap.normal.isZero(0)) return;
  SurfaceContact contact;
  contact.point = point;
  contact.shape = shape;
  contact.clearance = clearance;
  contact.distance = gap.distance - tool_.radius(shape);
  contact.normal = tool_.directionAtEnd(shape, fraction, gap.normal);
  contact.tool_point = tool_.pointAtEnd(shape, fraction, gap.core) + tool_.radius(shape) * contact.normal;
  if (!isBuried(contact)) contacts_.push_back(contact);
}

// Whether another shape covers this place of the shape.
bool SurfaceContacts::isBuried(const SurfaceContact& contact) const {
  const Eigen::Vector3d& p = contact.tool_point;
  for (int s = 0; s < tool_.count(); ++s)
    if (s != contact.shape && tool_.box(s).contains(p) && tool_.gap(s, 1, p).distance < tool_.radius(s) - kBuried)
      return true;
  return false;
}

void SurfaceContacts::removeDuplicates() {
  std::sort(contacts_.begin(), contacts_.end(), [](const SurfaceContact& one, const SurfaceContact& other) {
    const auto a = keyOf(one.point), b = keyOf(other.point);
    return std::tie(a, one.point.weight, one.distance, one.shape) <
           std::tie(b, other.point.weight, other.distance, other.shape);
  });
  std::size_t first = 0;  // kept at the present place
  for (const SurfaceContact& contact : contacts_) {
    if (kept_.empty() || !isSamePlace(kept_.back().point, contact.point)) first = kept_.size();
    const bool covered = std::any_of(kept_.begin() + static_cast<std::ptrdiff_t>(first), kept_.end(),
                                     [&contact](const SurfaceContact& deeper) { return isCoveredBy(deeper, contact); });
    if (!covered) kept_.push_back(contact);
  }
}

}  // namespace vibe
