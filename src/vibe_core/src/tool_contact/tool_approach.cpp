#include "tool_contact/tool_approach.hpp"

#include <algorithm>
#include <cmath>

#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>

#include "arithmetic/turn.hpp"
#include "vibe_core/solver/step_policy.hpp"

namespace vibe {

SweptTool::SweptTool(const ToolModel& model) {
  for (const ToolShape& shape : model.shapes()) shapes_.push_back(shapeOf(shape));
}

SweptTool::Shape SweptTool::shapeOf(const ToolShape& tool_shape) {
  Shape shape;
  shape.shape = tool_shape.shape.get();
  shape.link = tool_shape.link;
  shape.origin = tool_shape.origin;
  shape.corner.fill(Eigen::Vector3d::Zero());
  // The core of a sphere is a point, that of a capsule a segment: two ends describe both.
  const int kind = shape.shape->getShapeType();
  shape.round = kind == SPHERE_SHAPE_PROXYTYPE || kind == CAPSULE_SHAPE_PROXYTYPE;
  if (kind == SPHERE_SHAPE_PROXYTYPE) shape.radius = static_cast<const btSphereShape&>(*shape.shape).getRadius();
  if (kind == CAPSULE_SHAPE_PROXYTYPE) {
    const auto& capsule = static_cast<const btCapsuleShape&>(*shape.shape);
    shape.radius = capsule.getRadius();
    shape.corner[0][capsule.getUpAxis()] = -capsule.getHalfHeight();
    shape.corner[1][capsule.getUpAxis()] = capsule.getHalfHeight();
  }
  shape.corners = shape.round ? 2 : 8;
  // Others have no core: eight corners of the box around them bound their way.
  if (shape.round) return shape;
  btVector3 lower, upper;
  shape.shape->getAabb(btTransform::getIdentity(), lower, upper);
  for (int k = 0; k < 8; ++k)
    shape.corner[static_cast<std::size_t>(k)] = {(k & 1) != 0 ? upper.x() : lower.x(),
                                                 (k & 2) != 0 ? upper.y() : lower.y(),
                                                 (k & 4) != 0 ? upper.z() : lower.z()};
  return shape;
}

void SweptTool::place(const std::vector<Eigen::Isometry3d>& start, const std::vector<Eigen::Isometry3d>& end) {
  travel_ = 0;
  box_.setEmpty();
  for (Shape& shape : shapes_) {
    shape.start = start[shape.link] * shape.origin;
    shape.end = end[shape.link] * shape.origin;
    placeShape(shape);
    travel_ = std::max(travel_, shape.travel);
    box_.extend(shape.box);
  }
}

void SweptTool::placeShape(Shape& shape) {
  shape.turned_from = Eigen::Quaterniond(shape.start.linear());
  shape.turned_to = Eigen::Quaterniond(shape.end.linear());
  shape.travel = 0;
  shape.box.setEmpty();
  for (int k = 0; k < shape.corners; ++k) {
    const Eigen::Vector3d& corner = shape.corner[static_cast<std::size_t>(k)];
    const Eigen::Vector3d from = shape.start * corner, to = shape.end * corner;
    if (k < 2) shape.a[static_cast<std::size_t>(k)] = from, shape.b[static_cast<std::size_t>(k)] = to;
    shape.travel = std::max(shape.travel, (to - from).norm());
    shape.box.extend(from);
    shape.box.extend(to);
  }
  // A shape that turns leaves the box around its ends; a core with a radius moves along straight lines.
  const double grown = shape.radius + (shape.round ? 0 : stepPolicy().sweep_turn_margin * shape.travel);
  shape.box.min().array() -= grown;
  shape.box.max().array() += grown;
}

std::array<Eigen::Vector3d, 2> SweptTool::moves(int shape) const {
  const Shape& s = shapes_[shape];
  return {s.b[0] - s.a[0], s.b[1] - s.a[1]};
}

std::array<Eigen::Vector3d, 2> SweptTool::segment(int shape, double fraction) const {
  const Shape& s = shapes_[shape];
  return {s.a[0] + fraction * (s.b[0] - s.a[0]), s.a[1] + fraction * (s.b[1] - s.a[1])};
}

Eigen::Isometry3d SweptTool::poseAt(const Shape& shape, double fraction) {
  if (fraction == 0) return shape.start;
  if (fraction == 1) return shape.end;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = between(shape.turned_from, shape.turned_to, fraction).toRotationMatrix();
  pose.translation() = (1 - fraction) * shape.start.translation() + fraction * shape.end.translation();
  return pose;
}

TriangleGap SweptTool::gap(int shape, double fraction, const std::array<Eigen::Vector3d, 3>& triangle) const {
  const Shape& s = shapes_[shape];
  if (s.round) {
    const auto [a, b] = segment(shape, fraction);
    return segmentTriangleGap(a, b, triangle);
  }
  const Eigen::Isometry3d pose = poseAt(s, fraction), back = pose.inverse();
  TriangleGap gap = convexTriangleGap(*s.shape, {back * triangle[0], back * triangle[1], back * triangle[2]});
  gap.core = pose * gap.core;
  gap.normal = pose.linear() * gap.normal;
  return gap;
}

TriangleGap SweptTool::gap(int shape, double fraction, const Eigen::Vector3d& point) const {
  if (!shapes_[shape].round) return gap(shape, fraction, {point, point, point});
  const auto [a, b] = segment(shape, fraction);
  TriangleGap gap;
  gap.weight = {1, 0, 0};
  gap.core = nearestOnSegment(a, b, point);
  gap.normal = point - gap.core;
  gap.distance = gap.normal.norm();
  if (gap.distance > 0) gap.normal /= gap.distance;
  return gap;
}

Eigen::Vector3d SweptTool::pointAtEnd(int shape, double fraction, const Eigen::Vector3d& point) const {
  if (fraction == 1) return point;
  const Shape& s = shapes_[shape];
  return s.end * (poseAt(s, fraction).inverse() * point);
}

Eigen::Vector3d SweptTool::directionAtEnd(int shape, double fraction, const Eigen::Vector3d& direction) const {
  if (fraction == 1) return direction;
  const Shape& s = shapes_[shape];
  return s.end.linear() * (poseAt(s, fraction).linear().transpose() * direction);
}

namespace {

constexpr double kRounding = 1e-9;  // far above that of a position in double precision [m]

using Triangle = std::array<Eigen::Vector3d, 3>;

Triangle triangleAt(const SurfacePath& path, const std::array<int, 3>& n, double fraction) {
  return {path.at(n[0], fraction), path.at(n[1], fraction), path.at(n[2], fraction)};
}

// A bound of the relative motion of a shape and a triangle [m]; what they have in common does not count.
double closingDistance(const SweptTool& tool, int shape, const SurfacePath& path, const std::array<int, 3>& triangle) {
  const std::array<Eigen::Vector3d, 2> moves = tool.moves(shape);
  const Eigen::Vector3d common = 0.5 * (moves[0] + moves[1]);
  double wall = 0;
  for (const int v : triangle) wall = std::max(wall, (path.at(v, 1) - path.start(v) - common).norm());
  const double turn = 0.5 * (moves[1] - moves[0]).norm();
  return wall + (tool.radius(shape) > 0 ? turn : tool.travel(shape) + common.norm());
}

// The part of the step up to which the two are sure to stay apart. Ends of the core and vertices move along straight
// lines, and so do their distances along the direction in which they are apart now: where all of these stay above a
// floor, so does the distance.
double freeUntil(const SweptTool& tool, int shape, const SurfacePath& path, const std::array<int, 3>& triangle,
                 const ToolApproach& now, double floor, double aim) {
  const double left = 1 - now.fraction;
  // A shape without a segment turns: only a bound of its speed is known.
  if (!tool.hasSegment(shape)) {
    const double free = now.gap.distance - floor, speed = closingDistance(tool, shape, path, triangle);
    return free >= left * speed ? 1 : std::min(1.0, now.fraction + stepPolicy().sweep_share * free / speed);
  }
  const auto from = tool.segment(shape, now.fraction), to = tool.segment(shape, 1);
  // Distances of both ends of the core from the three vertices along the present normal are linear in time; the first
  // that comes down to the aim ends the advance.
  double part = 1;
  bool meets = false;
  for (const int v : triangle) {
    const double wall_from = now.gap.normal.dot(path.at(v, now.fraction)), wall_to = now.gap.normal.dot(path.at(v, 1));
    for (std::size_t k = 0; k < 2; ++k) {
      const double before = wall_from - now.gap.normal.dot(from[k]), after = wall_to - now.gap.normal.dot(to[k]);
      meets = meets || after < floor;
      if (after < aim) part = std::min(part, before > aim ? (before - aim) / (before - after) : 0);
    }
  }
  return meets ? now.fraction + left * part : 1;
}

}  // namespace

ToolApproach approach(const SweptTool& tool, int shape, const SurfacePath& path, const std::array<int, 3>& triangle,
                      double floor) {
  return approach(tool, shape, path, triangle, floor, tool.gap(shape, 0, triangleAt(path, triangle, 0)));
}

ToolApproach approach(const SweptTool& tool, int shape, const SurfacePath& path, const std::array<int, 3>& triangle,
                      double floor, const TriangleGap& start) {
  ToolApproach result;
  result.fraction = 0;
  result.gap = result.start = start;
  result.nearest = result.gap.distance;
  const StepPolicy& policy = stepPolicy();
  const double kept = policy.sweep_kept * (result.gap.distance - floor);
  for (int advance = 0; advance < policy.sweep_advances && result.fraction < 1; ++advance) {
    const double free = result.gap.distance - floor;
    // It ends before the two touch, where the normal is still that of the side on which the shape is.
    if (free <= 0 || (advance > 0 && free < kept)) break;
    const double next = freeUntil(tool, shape, path, triangle, result, floor, floor + policy.sweep_aim * kept);
    if (next == result.fraction) break;
    result.gap = tool.gap(shape, next, triangleAt(path, triangle, next));
    result.fraction = next;
  }
  result.nearest = std::min(result.nearest, result.gap.distance);
  return result;
}

bool staysApart(const SweptTool& tool, int shape, const SurfacePath& path, const std::array<int, 3>& triangle,
                double floor, double least) {
  if (!tool.hasSegment(shape)) return false;
  const auto from = tool.segment(shape, 0), to = tool.segment(shape, 1);
  const Triangle start = triangleAt(path, triangle, 0);
  // The direction in which the triangle's centre lies from the core at the start is tried, and no other.
  const Eigen::Vector3d centre = (start[0] + start[1] + start[2]) / 3;
  const Eigen::Vector3d away = centre - nearestOnSegment(from[0], from[1], centre);
  const double most = away.norm();  // of the distance at the start
  const Eigen::Vector3d direction = away / most;
  const double core_from = std::max(direction.dot(from[0]), direction.dot(from[1])),
               core_to = std::max(direction.dot(to[0]), direction.dot(to[1]));
  // Along it the distance at either end bounds that in between, because all points move along straight lines.
  double apart = most, way2 = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector3d end = path.at(triangle[k], 1);
    apart = std::min(apart, std::min(direction.dot(start[k]) - core_from, direction.dot(end) - core_to));
    way2 = std::max(way2, (end - start[k]).squaredNorm());
  }
  // approach() is certain to reach the end where half of its advances, each of the distance above its aim, are the way.
  const StepPolicy& policy = stepPolicy();
  const double certain = 0.5 * policy.sweep_advances, kept = policy.sweep_kept * (most - floor),
               way = std::sqrt(way2) + tool.travel(shape);
  return apart > least && apart > floor + kept + kRounding && (apart - floor - policy.sweep_aim * kept) * certain > way;
}

std::vector<char> shapesOnTip(const ToolModel& tool) {
  std::vector<char> carried(static_cast<std::size_t>(tool.linkCount()), 0);
  carried[tool.linkIndex("scope_tip")] = 1;
  for (const ToolJoint& joint : tool.joints())
    if (carried[joint.parent_link] != 0) carried[joint.child_link] = 1;
  std::vector<char> on_tip;
  for (const ToolShape& shape : tool.shapes()) on_tip.push_back(carried[shape.link]);
  return on_tip;
}

}  // namespace vibe
