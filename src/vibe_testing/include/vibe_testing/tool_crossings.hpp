#pragma once

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include "vibe_core/geometry/surface_mesh.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/tool/tool_model.hpp"
#include "vibe_testing/wall_crossings.hpp"

namespace vibe::test {

namespace solids {

/// A shape in its own frame: all points within `radius` of a segment along z, or a box, or a cylinder along z.
struct Solid {
  enum class Kind { Round, Box, Cylinder } kind = Kind::Round;  ///< what the shape is
  Eigen::Vector3d half = Eigen::Vector3d::Zero();               ///< of the box; z: of the segment or cylinder [m]
  double radius = 0;                                            ///< [m]
  Eigen::Isometry3d pose;                                       ///< in world [m]
};

/// Rotation that turns z into an axis.
inline Eigen::Matrix3d alongAxis(int axis) {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  if (axis == 0) turn << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  if (axis == 1) turn << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  return turn;
}

/// The shape of a tool whose link is at a pose in world.
inline Solid solidOf(const ToolShape& shape, const Eigen::Isometry3d& link) {
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

/// Distance of the segments from p to p + u and from q to q + v [m].
inline double segmentsApart(const Eigen::Vector3d& p, const Eigen::Vector3d& u, const Eigen::Vector3d& q,
                            const Eigen::Vector3d& v) {
  const Eigen::Vector3d w = p - q;
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
inline double aboveTriangle(const Eigen::Vector3d& p, const TriangleCorners& t) {
  const Eigen::Vector3d normal = (t[1] - t[0]).cross(t[2] - t[0]);
  for (std::size_t k = 0; k < 3; ++k)
    if ((t[(k + 1) % 3] - t[k]).cross(p - t[k]).dot(normal) < 0) return HUGE_VAL;
  return std::abs((p - t[0]).dot(normal)) / normal.norm();
}

/// How far a triangle reaches below the surface of a round shape [m], exactly; negative: it is outside.
inline double depthInRound(const Solid& solid, const TriangleCorners& t) {
  const Eigen::Vector3d begin(0, 0, -solid.half.z()), end(0, 0, solid.half.z());
  if (segmentPierces(begin, end, t)) return solid.radius;
  double apart = std::min(aboveTriangle(begin, t), aboveTriangle(end, t));
  for (std::size_t k = 0; k < 3; ++k)
    apart = std::min(apart, segmentsApart(begin, end - begin, t[k], t[(k + 1) % 3] - t[k]));
  return solid.radius - apart;
}

/// Depth of a point that is inside, otherwise negative.
inline double depthAt(const Solid& solid, const Eigen::Vector3d& p) {
  if (solid.kind == Solid::Kind::Box) return (solid.half - p.cwiseAbs()).minCoeff();
  return std::min(solid.radius - p.head<2>().norm(), solid.half.z() - std::abs(p.z()));
}

/// The same of any shape; of boxes and cylinders at samples of the triangle.
inline double depthInside(const Solid& solid, const TriangleCorners& t) {
  if (solid.kind == Solid::Kind::Round) return depthInRound(solid, t);
  constexpr int samples = 16;  // per edge
  double depth = -HUGE_VAL;
  for (int i = 0; i <= samples; ++i)
    for (int j = 0; i + j <= samples; ++j)
      depth = std::max(depth, depthAt(solid, t[0] + (t[1] - t[0]) * i / samples + (t[2] - t[0]) * j / samples));
  return depth;
}

/// Whether an axis of the shape, from end to end, passes through the triangle.
inline bool coreIn(const Solid& solid, const TriangleCorners& t) {
  for (int axis = solid.kind == Solid::Kind::Box ? 0 : 2; axis < 3; ++axis) {
    const Eigen::Vector3d end = solid.half[axis] * Eigen::Vector3d::Unit(axis);
    if (segmentPierces(-end, end, t)) return true;
  }
  return false;
}

/// Half of the sides of a box around the shape, in its frame.
inline Eigen::Vector3d extentOf(const Solid& solid) {
  if (solid.kind == Solid::Kind::Box) return solid.half;
  const double cap = solid.kind == Solid::Kind::Round ? solid.radius : 0;
  return {solid.radius, solid.radius, solid.half.z() + cap};
}

/// Whether a triangle is outside of the box with half sides `extent` [m].
inline bool apart(const TriangleCorners& t, const Eigen::Vector3d& extent) {
  const Eigen::Vector3d low = t[0].cwiseMin(t[1]).cwiseMin(t[2]), high = t[0].cwiseMax(t[1]).cwiseMax(t[2]);
  return !((low.array() <= extent.array()).all() && (high.array() >= -extent.array()).all());
}

}  // namespace solids

/// How far a tool and a wall pass through each other.
struct ToolCrossing {
  int pierced = 0;    ///< pairs of a triangle and a shape whose core passes through it
  double depth = 0;   ///< largest distance of a point of the wall below the surface of a shape; 0: all outside [m]
  int shape = -1;     ///< where it is: index in ToolModel::shapes(), -1: nowhere
  int triangle = -1;  ///< likewise
};

/// Tries all triangles against all shapes of the tool. The core of a capsule or cylinder is its axis, of a box the
/// three lines between the middles of opposite faces, of a sphere nothing. Depths in capsules and spheres are exact; in
/// boxes and cylinders they are those of points of the triangle at distances of a sixteenth of its edges. To check the
/// simulation from outside: it shares nothing with its contact.
/// @param link_poses  of the tool, in world
/// @param wall        its middle surface, in world
/// @param passes      triangles with such a vertex do not count, for ends that are open; (vertices), or empty
inline ToolCrossing findToolCrossing(const ToolModel& tool, const std::vector<Eigen::Isometry3d>& link_poses,
                                     const SurfaceView& wall, const std::vector<char>& passes) {
  ToolCrossing crossing;
  for (std::size_t k = 0; k < tool.shapes().size(); ++k) {
    const ToolShape& shape = tool.shapes()[k];
    const solids::Solid solid = solids::solidOf(shape, link_poses[static_cast<std::size_t>(shape.link)]);
    const Eigen::Isometry3d to_shape = solid.pose.inverse();
    const Eigen::Vector3d extent = solids::extentOf(solid);
    for (std::size_t n = 0; n < wall.triangles.size(); ++n) {
      const auto& corners = wall.triangles[n];
      const bool passed = !passes.empty() && std::any_of(corners.begin(), corners.end(), [&](int v) {
        return passes[static_cast<std::size_t>(v)] != 0;
      });
      const TriangleCorners t{to_shape * wall.position(corners[0]), to_shape * wall.position(corners[1]),
                              to_shape * wall.position(corners[2])};
      if (passed || solids::apart(t, extent)) continue;
      crossing.pierced += solids::coreIn(solid, t) ? 1 : 0;
      const double depth = solids::depthInside(solid, t);
      if (depth <= crossing.depth) continue;
      crossing.depth = depth;
      crossing.shape = static_cast<int>(k);
      crossing.triangle = static_cast<int>(n);
    }
  }
  return crossing;
}

}  // namespace vibe::test
