#include "contact/tool_approach.hpp"

#include <algorithm>
#include <cmath>

#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>

#include "common/turn.hpp"

namespace vibe {

namespace {

// The box of a turning shape is larger than that of its ends. Design choice: covers turns of two radians [1].
constexpr double kTurnMargin = 0.25;
constexpr std::size_t kBallGroup = 16;  // balls of a group. Design choice: a patch about as wide as a shape [1]
constexpr double kRounding = 1e-9;      // far above the rounding of a position in double precision [m]

}  // namespace

SweptTool::SweptTool(const ToolModel& model) {
  for (const ToolShape& shape : model.shapes()) shapes_.push_back(shapeOf(shape));
}

SweptTool::Shape SweptTool::shapeOf(const ToolShape& tool_shape) {
  Shape shape;
  shape.shape = tool_shape.shape.get();
  shape.link = tool_shape.link;
  shape.origin = tool_shape.origin;
  shape.corner.fill(Eigen::Vector3d::Zero());
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
  const double grown = shape.radius + (shape.round ? 0 : kTurnMargin * shape.travel);
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

constexpr int kApproachSteps = 40;      // steps towards a contact; each takes nine tenths of what is free
constexpr double kApproachShare = 0.9;  // of the distance above the floor per step [1]
constexpr double kKeptAtEnd = 0.1;      // of that distance at the start, at which an approach ends [1]
constexpr double kAim = 0.5;            // of that, at which steps along straight lines aim [1]

using Triangle = std::array<Eigen::Vector3d, 3>;

Triangle triangleAt(const SurfacePath& path, const std::array<int, 3>& n, double fraction) {
  return {path.at(n[0], fraction), path.at(n[1], fraction), path.at(n[2], fraction)};
}

// A bound of the relative motion of the two; what they have in common does not count.
double closingDistance(const SweptTool& tool, int shape, const SurfacePath& path, const std::array<int, 3>& triangle) {
  const std::array<Eigen::Vector3d, 2> moves = tool.moves(shape);
  const Eigen::Vector3d common = 0.5 * (moves[0] + moves[1]);
  double wall = 0;
  for (const int v : triangle) wall = std::max(wall, (path.at(v, 1) - path.start(v) - common).norm());
  const double turn = 0.5 * (moves[1] - moves[0]).norm();
  return wall + (tool.radius(shape) > 0 ? turn : tool.travel(shape) + common.norm());
}

// Up to where the two are sure to stay apart. Ends of the core and vertices move along straight lines, and so do their
// distances along the direction in which they are apart now: where all of these stay above a floor, so does the
// distance.
double freeUntil(const SweptTool& tool, int shape, const SurfacePath& path, const std::array<int, 3>& triangle,
                 const ToolApproach& now, double floor, double aim) {
  const double left = 1 - now.fraction;
  if (!tool.hasSegment(shape)) {
    const double free = now.gap.distance - floor, speed = closingDistance(tool, shape, path, triangle);
    return free >= left * speed ? 1 : std::min(1.0, now.fraction + kApproachShare * free / speed);
  }
  const auto from = tool.segment(shape, now.fraction), to = tool.segment(shape, 1);
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
  const double kept = kKeptAtEnd * (result.gap.distance - floor);
  for (int advance = 0; advance < kApproachSteps && result.fraction < 1; ++advance) {
    const double free = result.gap.distance - floor;
    if (free <= 0 || (advance > 0 && free < kept)) break;
    const double next = freeUntil(tool, shape, path, triangle, result, floor, floor + kAim * kept);
    if (next == result.fraction) break;
    result.gap = tool.gap(shape, next, triangleAt(path, triangle, next));
    result.fraction = next;
  }
  result.nearest = std::min(result.nearest, result.gap.distance);
  return result;
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

NearTriangles::NearTriangles(const SurfaceMesh& surface, const std::vector<char>& passable)
    : outside_(surface.vertices.size()) {
  for (const std::array<int, 3>& n : surface.triangles)
    if (passable[n[0]] == 0 && passable[n[1]] == 0 && passable[n[2]] == 0) triangles_.push_back(n);
}

void NearTriangles::classify(const Eigen::AlignedBox3d& box, const SurfacePath& path) {
  std::fill(outside_.begin(), outside_.end(), static_cast<unsigned char>(0));
  for (std::size_t k = 0; k < 3; ++k) {
    const double low = box.min()[static_cast<int>(k)], high = box.max()[static_cast<int>(k)];
    const double *const from = path.from[k], *const to = path.to[k];
    const unsigned below = 1U << (2 * k), above = 2U << (2 * k);
    for (std::size_t i = 0; i < outside_.size(); ++i) {
      const unsigned is_below = static_cast<unsigned>(from[i] < low) & static_cast<unsigned>(to[i] < low);
      const unsigned is_above = static_cast<unsigned>(from[i] > high) & static_cast<unsigned>(to[i] > high);
      outside_[i] = static_cast<unsigned char>(outside_[i] | (is_below * below) | (is_above * above));
    }
  }
}

void NearTriangles::collectBalls(const SurfacePath& path) {
  balls_.clear();
  for (int t = 0; t < static_cast<int>(triangles_.size()); ++t) {
    const auto& [a, b, c] = triangles_[t];
    if ((outside_[a] & outside_[b] & outside_[c]) != 0) continue;
    Ball ball{t, (path.start(a) + path.start(b) + path.start(c)) / 3, 0, 0};
    for (const int v : {a, b, c}) {
      const Eigen::Vector3d from = path.start(v);
      ball.radius = std::max(ball.radius, (from - ball.centre).squaredNorm());
      ball.move = std::max(ball.move, (path.at(v, 1) - from).squaredNorm());
    }
    ball.radius = std::sqrt(ball.radius), ball.move = std::sqrt(ball.move);
    if (std::isfinite(ball.centre.sum() + ball.radius + ball.move)) balls_.push_back(ball);
  }
}

void NearTriangles::find(const SweptTool& tool, const SurfacePath& path, double reach, std::vector<Pair>& found) {
  found.clear();
  Eigen::AlignedBox3d all = tool.box();
  all.min().array() -= reach, all.max().array() += reach;
  classify(all, path);
  collectBalls(path);
  groupBalls(reach);
  for (int s = 0; s < tool.count(); ++s)
    for (const Group& group : groups_)
      if (group.box.intersects(tool.box(s))) findIn(group, tool, s, reach, found);
}

// Triangles that follow each other are mostly neighbours.
void NearTriangles::groupBalls(double reach) {
  groups_.clear();
  for (std::size_t first = 0; first < balls_.size(); first += kBallGroup) {
    Group group{first, std::min(first + kBallGroup, balls_.size()), {}};
    for (std::size_t i = group.first; i < group.last; ++i) {
      const Eigen::Vector3d near = Eigen::Vector3d::Constant(balls_[i].radius + balls_[i].move + reach + kRounding);
      group.box.extend(balls_[i].centre - near);
      group.box.extend(balls_[i].centre + near);
    }
    groups_.push_back(group);
  }
}

void NearTriangles::findIn(const Group& group, const SweptTool& tool, int shape, double reach,
                           std::vector<Pair>& found) const {
  const Eigen::Vector3d low = tool.box(shape).min(), high = tool.box(shape).max();
  const auto [a, b] = tool.segment(shape, 0);
  const double grown = tool.radius(shape) + tool.travel(shape) + reach;
  for (std::size_t i = group.first; i < group.last; ++i) {
    const Ball& ball = balls_[i];
    const double near = ball.radius + ball.move + reach;
    if (((ball.centre - high).array() > near).any() || ((low - ball.centre).array() > near).any()) continue;
    const double apart = tool.hasSegment(shape) ? (ball.centre - nearestOnSegment(a, b, ball.centre)).norm() : 0;
    if (apart <= grown + ball.radius + ball.move) found.push_back({shape, ball.triangle});
  }
}

}  // namespace vibe
