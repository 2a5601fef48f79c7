#include "contact/swept_tool.hpp"

#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>

#include <algorithm>

#include "common/turn.hpp"

namespace vibe {

namespace {

// The box of a turning shape is larger than that of its ends. Design choice: covers turns of two radians [1].
constexpr double kTurnMargin = 0.25;

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

}  // namespace vibe
