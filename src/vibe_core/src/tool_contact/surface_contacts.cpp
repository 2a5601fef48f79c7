#include "tool_contact/surface_contacts.hpp"

#include <algorithm>
#include <map>
#include <tuple>

namespace vibe {

namespace {

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

// The vertices of a point, ascending; absent ones first.
std::array<int, 3> keyOf(const SurfacePoint& point) {
  auto [a, b, c] = point.node;
  if (a > b) std::swap(a, b);
  if (b > c) std::swap(b, c);
  if (a > b) std::swap(a, b);
  return {a, b, c};
}

bool isSamePoint(const SurfacePoint& one, const SurfacePoint& other) {
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
    : policy_(stepPolicy()),
      tool_(tool),
      on_tip_(shapesOnTip(tool)),
      near_triangles_(surface, passable),
      passage_(tool, thickness),
      triangles_(near_triangles_.triangles()),
      neighbour_(neighbours(triangles_)) {
  for (const double t : thickness) {
    half_thickness_.push_back(0.5 * t);
    max_half_thickness_ = std::max(max_half_thickness_, 0.5 * t);
  }
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
                                                         const std::vector<char>& excluded, double when,
                                                         bool needle_leads) {
  contacts_.clear(), kept_.clear();
  when_ = when;
  tool_.place(start, end);
  near_triangles_.find(tool_, path, max_half_thickness_ + margin, near_);
  passage_.open(start, needle_leads, tool_, path, triangles_, near_);
  for (std::size_t first = 0, last = 0; first < near_.size(); first = last) {
    const int shape = near_[first].shape;
    while (last < near_.size() && near_[last].shape == shape) ++last;
    followPairs(path, margin, first, last);
    addVertices(path, margin, shape, excluded);
    addBetween(path, margin, shape, excluded);
    addNearest(shape, excluded);
    for (const Pair& pair : pairs_) pair_of_[pair.triangle] = -1;
  }
  removeBeside();
  return kept_;
}

// Lists the triangles that come within reach of a shape, and their vertices.
// @param first, last  of the shape in near_
void SurfaceContacts::followPairs(const SurfacePath& path, double margin, std::size_t first, std::size_t last) {
  pairs_.clear(), vertices_.clear();
  ++count_;
  fraction_ = 1;
  for (std::size_t k = first; k < last; ++k) {
    const auto [shape, t] = near_[k];
    const std::array<int, 3>& n = triangles_[t];
    const double radius = tool_.radius(shape);
    // A path is followed to this distance from the core, where a normal can still be taken.
    const double floor = std::max(policy_.touch_deepest * radius,
                                  policy_.touch_deepest_in_wall * halfThickness(n, Eigen::Vector3d::Constant(1. / 3)));
    if (staysApart(tool_, shape, path, n, floor, radius + max_half_thickness_ + margin)) continue;
    const Pair pair{t, approach(tool_, shape, path, n, floor)};
    if (pair.approach.fraction == 1 && pair.approach.nearest - radius - max_half_thickness_ > margin) continue;
    // A vertex counts as hit where the shape would pass through any of its triangles.
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

// Whether the helix draws the wall at one of the vertices into the device that the shape is part of.
bool SurfaceContacts::isDrawnIn(int shape, std::initializer_list<int> vertices,
                                const std::vector<char>& excluded) const {
  return on_tip_[shape] != 0 &&
         std::any_of(vertices.begin(), vertices.end(), [&](int vertex) { return excluded[vertex] == kHeld; });
}

// Adds a contact of a point of the wall with a shape where they come within reach.
// @param hit    the shape would pass through the wall there
// @param share  of the distance that it keeps
void SurfaceContacts::offer(const SurfacePoint& point, const SurfacePath& path, int shape, bool hit, double margin,
                            double share) {
  const auto pointAt = [&](double when) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < static_cast<std::size_t>(point.count); ++k)
      sum += point.weight[k] * path.at(point.node[k], when);
    return sum;
  };
  double clearance = 0;
  for (std::size_t k = 0; k < static_cast<std::size_t>(point.count); ++k)
    clearance += share * point.weight[k] * half_thickness_[point.node[k]];
  const auto gapAt = [&](double when) { return tool_.gap(shape, when, pointAt(when)); };
  const double reach = tool_.radius(shape) + clearance + margin;
  // All triangles of the shape are looked at, at the moment up to which none is passed: so their normals agree.
  double fraction = fraction_;
  TriangleGap gap = gapAt(fraction);
  if (!hit && gap.distance > reach) {  // it leaves; yet it may come back
    gap = gapAt(fraction = 0);
    if (gap.distance > reach) return;
  }
  if (fraction < 1)
    add(point, shape, fraction, gap, clearance);
  else
    addAlong(point, shape, pointAt(0), pointAt(1), gap, clearance);
}

// Adds a contact that acts along the normal that the point has at the moment at which the forces of the step act, on
// its straight way as seen from the shape. Where the wall resists at one moment and the shape pushes along the normal
// of another, a tip that slides is driven or braked by the angle between them (equation (10) ff. of
// docs/computation.md). The distance is that at the end.
// @param start, end  positions of the point
// @param gap         at the end
void SurfaceContacts::addAlong(const SurfacePoint& point, int shape, const Eigen::Vector3d& start,
                               const Eigen::Vector3d& end, const TriangleGap& gap, double clearance) {
  const TriangleGap before = tool_.gap(shape, 0, start);
  const Eigen::Vector3d from = tool_.directionAtEnd(shape, 0, before.normal);
  // A normal between two that differ much is no normal of the shape.
  if (!(from.dot(gap.normal) > policy_.touch_along)) return add(point, shape, 1, gap, clearance);
  SurfaceContact contact;
  contact.point = point;
  contact.shape = shape;
  contact.clearance = clearance;
  contact.distance = gap.distance - tool_.radius(shape);
  contact.normal = ((1 - when_) * before.distance * from + when_ * gap.distance * gap.normal).normalized();
  contact.tool_point = end - contact.distance * contact.normal;
  addOutside(contact, end, gap.core);
}

void SurfaceContacts::add(const SurfacePoint& point, int shape, double fraction, const TriangleGap& gap,
                          double clearance, bool nearest) {
  if (gap.normal.isZero(0)) return;
  SurfaceContact contact;
  contact.nearest = nearest;
  contact.point = point;
  contact.shape = shape;
  contact.clearance = clearance;
  contact.distance = gap.distance - tool_.radius(shape);
  contact.normal = tool_.directionAtEnd(shape, fraction, gap.normal);
  const Eigen::Vector3d core = tool_.pointAtEnd(shape, fraction, gap.core);
  contact.tool_point = core + tool_.radius(shape) * contact.normal;
  addOutside(contact, core + gap.distance * contact.normal, core);
}

// Adds a contact unless another shape of the tool covers the point of this one, so that the wall cannot touch it. In a
// corner between two shapes the wall is nearer to the other one by at least the depth in it, and the contact keeps a
// part of that less: when it goes it has no force. If it kept all of that less, a wall beyond the corner would be led
// as far beyond on the other side.
// @param wall, core  the point of the wall and that of the core, at the end of the step
void SurfaceContacts::addOutside(SurfaceContact& contact, const Eigen::Vector3d& wall, const Eigen::Vector3d& core) {
  double deepest = 0;
  for (int s = 0; s < tool_.count(); ++s) {
    if (s == contact.shape || passage_.isAway(s) || !tool_.box(s).contains(contact.tool_point)) continue;
    if (isLeftTo(s, contact.shape, wall, core)) return;
    deepest = std::max(deepest, tool_.radius(s) - tool_.gap(s, 1, contact.tool_point).distance);
  }
  if (deepest > policy_.touch_corner) return;
  contact.clearance -= std::clamp(policy_.touch_corner_slack * deepest, 0.0, 0.5 * contact.clearance);
  contacts_.push_back(contact);
}

// Whether the other shape has the contact instead: where a round end goes on into it without a corner, as on the
// outside of a bend. Two contacts that say the same would share the load like two springs. Where both ends are nearest
// to the wall, the first shape has it.
bool SurfaceContacts::isLeftTo(int other, int shape, const Eigen::Vector3d& wall, const Eigen::Vector3d& core) const {
  if (!goesOnInto(other, shape, core)) return false;
  if (goesOnInto(shape, other, tool_.gap(other, 1, wall).core)) return other < shape;
  // shapes that share an end have a corner on the side to which they bend
  const Eigen::Vector3d from_end = wall - core;
  return !goesOnInto(shape, other, core) || from_end.dot(inwards(shape, core) + inwards(other, core)) <= 0;
}

// The direction of a shape's core from that of its ends which is at a point.
Eigen::Vector3d SurfaceContacts::inwards(int shape, const Eigen::Vector3d& end) const {
  const auto [a, b] = tool_.segment(shape, 1);
  return ((a - end).squaredNorm() < (b - end).squaredNorm() ? b - a : a - b).normalized();
}

// Whether a point of a shape's core is an end whose round is all within another shape.
bool SurfaceContacts::goesOnInto(int other, int shape, const Eigen::Vector3d& core) const {
  if (!tool_.hasSegment(shape)) return false;
  const auto ends = tool_.segment(shape, 1);
  const double from_end = std::min((core - ends[0]).norm(), (core - ends[1]).norm());
  return from_end < policy_.touch_within &&
         tool_.gap(other, 1, core).distance + tool_.radius(shape) <= tool_.radius(other) + policy_.touch_within;
}

// A point inside a shape has one way out: that of the shape in which it is deepest. Outside, it keeps off those that
// are about as near as the nearest one, and those that it would go through.
void SurfaceContacts::removeBeside() {
  std::sort(contacts_.begin(), contacts_.end(), [](const SurfaceContact& one, const SurfaceContact& other) {
    const auto a = keyOf(one.point), b = keyOf(other.point);
    return std::tie(a, one.point.weight, one.distance, one.shape) <
           std::tie(b, other.point.weight, other.distance, other.shape);
  });
  const SurfaceContact* nearest = nullptr;  // of the present point
  const auto gap = [](const SurfaceContact& contact) { return contact.distance - contact.clearance; };
  for (const SurfaceContact& contact : contacts_) {
    if (nearest == nullptr || !isSamePoint(nearest->point, contact.point)) nearest = &contact;
    const bool beside = nearest->distance >= 0 &&
                        gap(contact) < std::max(-0.5 * contact.clearance, gap(*nearest) + policy_.touch_beside);
    if (nearest == &contact || beside) kept_.push_back(contact);
  }
}

}  // namespace vibe
