#include "vibe_core/tool_contact/tool_crossings.hpp"

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "vibe_core/program/error.hpp"
#include "vibe_core/self_contact/wall_crossings.hpp"

namespace vibe {

namespace {

using Eigen::Vector3d;
using Triangle = std::array<Vector3d, 3>;

constexpr int kSamples = 16;  // per edge

/// A shape in its own frame: all points within `radius` of a segment along z, or a box, or a cylinder along z.
struct Solid {
  enum class Kind { Round, Box, Cylinder } kind = Kind::Round;
  Vector3d half = Vector3d::Zero();  ///< of the box; z: of the segment or cylinder [m]
  double radius = 0;                 ///< [m]
  Eigen::Isometry3d pose;            ///< in world
};

/// Rotation that turns z into an axis.
Eigen::Matrix3d alongAxis(int axis) {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  if (axis == 0) turn << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  if (axis == 1) turn << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  return turn;
}

Solid solidOf(const ToolShape& shape, const Eigen::Isometry3d& link) {
  Solid solid;
  solid.pose = link * shape.origin;
  switch (shape.shape->getShapeType()) {
    case SPHERE_SHAPE_PROXYTYPE:
      solid.radius = static_cast<const btSphereShape&>(*shape.shape).getRadius();
      return solid;
    case CAPSULE_SHAPE_PROXYTYPE: {
      const auto& capsule = static_cast<const btCapsuleShape&>(*shape.shape);
      solid.radius = capsule.getRadius();
      solid.half.z() = capsule.getHalfHeight();
      solid.pose.linear() = solid.pose.linear() * alongAxis(capsule.getUpAxis());
      return solid;
    }
    case CYLINDER_SHAPE_PROXYTYPE: {
      const auto& cylinder = static_cast<const btCylinderShape&>(*shape.shape);
      solid.kind = Solid::Kind::Cylinder;
      solid.radius = cylinder.getRadius();
      solid.half.z() = cylinder.getHalfExtentsWithMargin()[cylinder.getUpAxis()];
      solid.pose.linear() = solid.pose.linear() * alongAxis(cylinder.getUpAxis());
      return solid;
    }
    case BOX_SHAPE_PROXYTYPE: {
      const btVector3 half = static_cast<const btBoxShape&>(*shape.shape).getHalfExtentsWithMargin();
      solid.kind = Solid::Kind::Box;
      solid.half = {half.x(), half.y(), half.z()};
      return solid;
    }
    default:
      throw Error("A collision shape of the tool is none of capsule, cylinder, sphere and box; use one of these.");
  }
}

double segmentsApart(const Vector3d& p, const Vector3d& u, const Vector3d& q, const Vector3d& v) {
  const Vector3d w = p - q;
  const double a = u.squaredNorm(), b = u.dot(v), c = v.squaredNorm(), d = u.dot(w), e = v.dot(w);
  const double det = a * c - b * b;
  double s = det > 1e-12 * a * c ? std::clamp((b * e - c * d) / det, 0.0, 1.0) : 0.0;
  double t = c > 0 ? (b * s + e) / c : 0.0;
  if (t < 0 || t > 1) {
    t = std::clamp(t, 0.0, 1.0);
    s = a > 0 ? std::clamp((b * t - d) / a, 0.0, 1.0) : 0.0;
  }
  return (w + s * u - t * v).norm();
}

/// Distance of a point from the inside of a triangle; infinite if its foot is outside.
double aboveTriangle(const Vector3d& p, const Triangle& t) {
  const Vector3d normal = (t[1] - t[0]).cross(t[2] - t[0]);
  for (std::size_t k = 0; k < 3; ++k)
    if ((t[(k + 1) % 3] - t[k]).cross(p - t[k]).dot(normal) < 0) return HUGE_VAL;
  return std::abs((p - t[0]).dot(normal)) / normal.norm();
}

double depthInRound(const Solid& solid, const Triangle& t) {
  const Vector3d begin(0, 0, -solid.half.z()), end(0, 0, solid.half.z());
  if (segmentPierces(begin, end, t)) return solid.radius;
  double apart = std::min(aboveTriangle(begin, t), aboveTriangle(end, t));
  for (std::size_t k = 0; k < 3; ++k)
    apart = std::min(apart, segmentsApart(begin, end - begin, t[k], t[(k + 1) % 3] - t[k]));
  return solid.radius - apart;
}

/// Depth of a point that is inside, otherwise negative.
double depthAt(const Solid& solid, const Vector3d& p) {
  if (solid.kind == Solid::Kind::Box) return (solid.half - p.cwiseAbs()).minCoeff();
  return std::min(solid.radius - p.head<2>().norm(), solid.half.z() - std::abs(p.z()));
}

double depthInside(const Solid& solid, const Triangle& t) {
  if (solid.kind == Solid::Kind::Round) return depthInRound(solid, t);
  double depth = -HUGE_VAL;
  for (int i = 0; i <= kSamples; ++i)
    for (int j = 0; i + j <= kSamples; ++j)
      depth = std::max(depth, depthAt(solid, t[0] + (t[1] - t[0]) * i / kSamples + (t[2] - t[0]) * j / kSamples));
  return depth;
}

bool coreIn(const Solid& solid, const Triangle& t) {
  for (int axis = solid.kind == Solid::Kind::Box ? 0 : 2; axis < 3; ++axis) {
    const Vector3d end = solid.half[axis] * Vector3d::Unit(axis);
    if (segmentPierces(-end, end, t)) return true;
  }
  return false;
}

bool passesThrough(const std::array<int, 3>& corners, const std::vector<char>& passes) {
  return !passes.empty() &&
         std::any_of(corners.begin(), corners.end(), [&](int v) { return passes[static_cast<std::size_t>(v)] != 0; });
}

/// Half of the sides of a box around the shape, in its frame.
Vector3d extentOf(const Solid& solid) {
  if (solid.kind == Solid::Kind::Box) return solid.half;
  const double cap = solid.kind == Solid::Kind::Round ? solid.radius : 0;
  return {solid.radius, solid.radius, solid.half.z() + cap};
}

bool apart(const Triangle& t, const Vector3d& extent) {
  const Vector3d low = t[0].cwiseMin(t[1]).cwiseMin(t[2]), high = t[0].cwiseMax(t[1]).cwiseMax(t[2]);
  return !((low.array() <= extent.array()).all() && (high.array() >= -extent.array()).all());
}

}  // namespace

ToolCrossing findToolCrossing(const ToolModel& tool, const std::vector<Eigen::Isometry3d>& link_poses,
                              const SurfaceView& wall, const std::vector<char>& passes) {
  ToolCrossing crossing;
  for (std::size_t k = 0; k < tool.shapes().size(); ++k) {
    const ToolShape& shape = tool.shapes()[k];
    const Solid solid = solidOf(shape, link_poses[static_cast<std::size_t>(shape.link)]);
    const Eigen::Isometry3d to_shape = solid.pose.inverse();
    const Vector3d extent = extentOf(solid);
    for (std::size_t n = 0; n < wall.triangles.size(); ++n) {
      const auto& corners = wall.triangles[n];
      const Triangle t{to_shape * wall.position(corners[0]), to_shape * wall.position(corners[1]),
                       to_shape * wall.position(corners[2])};
      if (apart(t, extent) || passesThrough(corners, passes)) continue;
      crossing.pierced += coreIn(solid, t) ? 1 : 0;
      const double depth = depthInside(solid, t);
      if (depth <= crossing.depth) continue;
      crossing.depth = depth;
      crossing.shape = static_cast<int>(k);
      crossing.triangle = static_cast<int>(n);
    }
  }
  return crossing;
}

}  // namespace vibe
