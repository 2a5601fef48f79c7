#include "procedure/needle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "arithmetic/elementary.hpp"
#include "arithmetic/turn.hpp"
#include "vibe_core/geometry/surface_disc.hpp"
#include "vibe_core/geometry/triangle_tree.hpp"

namespace vibe {

namespace {

constexpr int kSamples = 64;        // of the path; 0.2 mm apart on that of the needle; design choice
constexpr double kOnEdge = 1e-6;    // barycentric coordinate below which a point lies on an edge
constexpr double kTouching = 1e-9;  // [m]

using Corners = std::array<Eigen::Vector3d, 3>;

struct Candidate {
  int triangle;
  Corners corners;
  Eigen::Vector3d centre;
  double radius;  // of a ball around the centre that holds the triangle
};

double distanceFromSegment(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d ab = b - a;
  const double length2 = ab.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - a).dot(ab) / length2, 0.0, 1.0) : 0;
  return (p - a - t * ab).norm();
}

// Every point of the path has a vertex within this distance: the distance to a vertex is largest at an end of the path.
double reachOfPath(const SurfaceView& wall, const Eigen::Vector3d& begin, const Eigen::Vector3d& end) {
  double min = std::numeric_limits<double>::infinity();
  for (int v = 0; v < static_cast<int>(wall.x.size()); ++v) {
    const Eigen::Vector3d p = wall.position(v);
    min = std::min(min, std::max((p - begin).squaredNorm(), (p - end).squaredNorm()));
  }
  return std::sqrt(min);
}

// Those that may be the nearest of a point of the path, or touch such a triangle where it is nearest.
std::vector<Candidate> trianglesNear(const SurfaceView& wall, const Eigen::Vector3d& begin,
                                     const Eigen::Vector3d& end) {
  const double reach = reachOfPath(wall, begin, end) + kTouching;
  const Eigen::AlignedBox3d box(begin.cwiseMin(end).array() - reach - kTouching,
                                begin.cwiseMax(end).array() + reach + kTouching);
  std::vector<std::uint8_t> sides(wall.x.size());
  for (std::size_t v = 0; v < sides.size(); ++v) sides[v] = sidesBeyond(box, wall.position(static_cast<int>(v)));
  std::vector<Candidate> near;
  for (int t = 0; t < static_cast<int>(wall.triangles.size()); ++t) {
    const auto& v = wall.triangles[t];
    if ((sides[v[0]] & sides[v[1]] & sides[v[2]]) != 0) continue;
    Candidate c{t, {wall.position(v[0]), wall.position(v[1]), wall.position(v[2])}, Eigen::Vector3d::Zero(), 0};
    c.centre = (c.corners[0] + c.corners[1] + c.corners[2]) / 3;
    for (const Eigen::Vector3d& corner : c.corners) c.radius = std::max(c.radius, (corner - c.centre).norm());
    if (distanceFromSegment(c.centre, begin, end) - c.radius <= reach) near.push_back(c);
  }
  return near;
}

// Angle of a triangle at one of its points: the full angle inside, half of it on an edge.
double angleAround(const Corners& c, const Eigen::Vector3d& p) {
  const Eigen::Vector3d normal = (c[1] - c[0]).cross(c[2] - c[0]);
  const double area2 = normal.squaredNorm();
  if (!(area2 > 0)) return 0;
  int edges = 0, corner = 0;
  double max = -1;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d &a = c[(k + 1) % 3], &b = c[(k + 2) % 3];
    const double share = normal.dot((b - a).cross(p - a)) / area2;
    if (share < kOnEdge) ++edges;
    if (share > max) max = share, corner = k;
  }
  if (edges == 0) return 2 * kPi;
  if (edges == 1) return kPi;
  const Eigen::Vector3d u = c[(corner + 1) % 3] - c[corner], v = c[(corner + 2) % 3] - c[corner];
  return math::atan2(u.cross(v).norm(), u.dot(v));
}

Eigen::Vector3d pseudonormal(const std::vector<Candidate>& near, const Eigen::Vector3d& p) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Candidate& c : near) {
    if ((c.centre - p).norm() > c.radius + kTouching) continue;
    if ((closestPointOnTriangle(p, c.corners[0], c.corners[1], c.corners[2]) - p).norm() > kTouching) continue;
    const Eigen::Vector3d normal = (c.corners[1] - c.corners[0]).cross(c.corners[2] - c.corners[0]);
    if (normal.norm() > 0) sum += angleAround(c.corners, p) * normal.normalized();
  }
  return sum;
}

// Without a sign.
// @param within  some triangle is nearer to p than this [m]
DeepestPoint nearestTo(const Eigen::Vector3d& p, double within, const std::vector<Candidate>& near) {
  DeepestPoint best;
  best.distance = std::numeric_limits<double>::infinity();
  for (const Candidate& c : near) {
    const double reached = std::min(within, best.distance) + c.radius;
    if ((c.centre - p).squaredNorm() > reached * reached) continue;
    const Eigen::Vector3d point = closestPointOnTriangle(p, c.corners[0], c.corners[1], c.corners[2]);
    const double distance = (point - p).norm();
    if (distance >= best.distance) continue;
    best = {c.triangle, point, distance};
  }
  return best;
}

}  // namespace

DeepestPoint deepestPoint(const SurfaceView& wall, const Eigen::Vector3d& begin, const Eigen::Vector3d& end) {
  const std::vector<Candidate> near = trianglesNear(wall, begin, end);
  const double apart = (end - begin).norm() / kSamples;
  double within = std::numeric_limits<double>::infinity();
  DeepestPoint deepest;
  for (int k = 0; k <= kSamples; ++k) {
    const double part = static_cast<double>(k) / kSamples;
    const Eigen::Vector3d p = begin + part * (end - begin);
    DeepestPoint at = nearestTo(p, within, near);
    if (at.triangle < 0) continue;
    within = at.distance + apart + kTouching;                                // of the next point
    if (deepest.triangle >= 0 && at.distance <= deepest.distance) continue;  // whatever its sign
    if ((p - at.point).dot(pseudonormal(near, at.point)) < 0) at.distance = -at.distance;
    if (deepest.triangle < 0 || at.distance > deepest.distance) deepest = at;
  }
  return deepest;
}

namespace {

constexpr double kMaxDepth = 0.01;  // half of the width of the curved needle, which reaches no deeper [m]

double thicknessAround(const Model& model, const Bite& bite) {
  double sum = 0;
  for (std::size_t k = 0; k < bite.particle.size(); ++k)
    sum += bite.weight[k] * model.organ.thickness[bite.particle[k]];
  return sum;
}

}  // namespace

int nearestParticle(const Bite& bite) {
  if (bite.particle.empty()) return -1;
  return bite.particle[std::max_element(bite.weight.begin(), bite.weight.end()) - bite.weight.begin()];
}

std::pair<Eigen::Vector3d, Eigen::Vector3d> needlePath(const Model& model,
                                                       const std::vector<Eigen::Isometry3d>& link_poses) {
  const ToolJoint& joint = model.tool->joints()[static_cast<std::size_t>(model.needle_link) - 1];
  const JointLimits& limits = model.tool->limits()[NeedleDriver];
  const auto pointAt = [&](double input) -> Eigen::Vector3d {
    const Eigen::Vector3d along = joint.axis * (joint.multiplier * input + joint.offset);
    return link_poses[joint.parent_link] * (joint.origin * along);
  };
  return {pointAt(limits.lower + kFreeSwing * (limits.upper - limits.lower)), pointAt(limits.upper)};
}

Bite biteAround(const Model& model, const SurfaceView& wall, int triangle, const Eigen::Vector3d& point,
                double radius) {
  DiscWeights disc = discWeights(model.organ.surface, wall, triangle, point, radius);
  Bite bite;
  bite.particle = std::move(disc.vertex);
  bite.weight = std::move(disc.weight);
  const int nearest = nearestParticle(bite);
  bite.thickness = thicknessAround(model, bite);
  bite.region = model.organ.region[nearest];
  bite.wall = model.organ.wall[nearest];
  for (std::size_t k = 0; k < bite.particle.size() && !model.along.empty(); ++k)
    bite.along += bite.weight[k] * model.along[bite.particle[k]];
  return bite;
}

NeedleReach reachOfNeedle(const Model& model, const State& state, const Eigen::Vector3d& begin,
                          const Eigen::Vector3d& end) {
  const SurfaceView wall{model.organ.surface.triangles, state.x, state.y, state.z};
  const DeepestPoint deepest = deepestPoint(wall, begin, end);
  NeedleReach reach;
  reach.depth = -1;  // a gap of one metre if no triangle of the wall has finite positions
  if (deepest.triangle < 0) return reach;
  Bite bite = biteAround(model, wall, deepest.triangle, deepest.point, model.scene.suture->bite_radius);
  reach.depth = std::min(deepest.distance + 0.5 * bite.thickness, kMaxDepth);
  if (reach.depth <= 0) return reach;
  bite.depth = reach.depth;
  bite.time = state.time;
  reach.bite = std::move(bite);
  return reach;
}

}  // namespace vibe
