#include "tool_contact/shape_distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btConvexShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/CollisionShapes/btTriangleShape.h>
#include <BulletCollision/CollisionShapes/btUniformScalingShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpa2.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPointCollector.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>
#include <LinearMath/btVector3.h>
#include <Eigen/Core>

#include "geometry/triangle_distance.hpp"

namespace vibe {

/// Diagonal to which a shape is scaled for Bullet's GJK, whose margins and tolerances are absolute: a tool shape of 1
/// cm had an error of 4 mm; scaled it does not [Bullet's units]. A unit of another library, which steers no step.
constexpr double kGjkSize = 100;

inline Eigen::Vector3d toEigen(const btVector3& v) {
  return {v.x(), v.y(), v.z()};
}

/// @param scale  factor on all coordinates
inline btVector3 toBullet(const Eigen::Vector3d& p, double scale) {
  return {static_cast<btScalar>(scale * p.x()), static_cast<btScalar>(scale * p.y()),
          static_cast<btScalar>(scale * p.z())};
}

namespace {

constexpr double kNoDirection = 1e-15;  // a shorter vector is rounding error and has no direction [m]

}  // namespace

PointDistance::PointDistance(const btConvexShape& shape) : shape_(&shape) {
  // Bullet's own distance goes through GJK, with an error of a part of the shape's size: closed forms have none.
  switch (shape.getShapeType()) {
    case SPHERE_SHAPE_PROXYTYPE:
      kind_ = Kind::Sphere;
      radius_ = static_cast<const btSphereShape&>(shape).getRadius();
      break;
    case CAPSULE_SHAPE_PROXYTYPE: {
      const auto& capsule = static_cast<const btCapsuleShape&>(shape);
      kind_ = Kind::Capsule;
      axis_ = capsule.getUpAxis();
      radius_ = capsule.getRadius();
      half_length_ = capsule.getHalfHeight();
      break;
    }
    case BOX_SHAPE_PROXYTYPE:
      if (shape.getMargin() > 0) break;  // Bullet rounds the edges of such shapes
      kind_ = Kind::Box;
      half_ = toEigen(static_cast<const btBoxShape&>(shape).getHalfExtentsWithMargin());
      break;
    case CYLINDER_SHAPE_PROXYTYPE: {
      if (shape.getMargin() > 0) break;
      const auto& cylinder = static_cast<const btCylinderShape&>(shape);
      kind_ = Kind::Cylinder;
      axis_ = cylinder.getUpAxis();
      radius_ = cylinder.getRadius();
      half_length_ = toEigen(cylinder.getHalfExtentsWithMargin())[axis_];
      break;
    }
    default:
      break;
  }
}

double PointDistance::operator()(const Eigen::Vector3d& p, Eigen::Vector3d& normal) const {
  switch (kind_) {
    case Kind::Sphere:
      return fromSphere(p, normal);
    case Kind::Capsule: {
      Eigen::Vector3d from_core = p;
      from_core[axis_] -= std::clamp(p[axis_], -half_length_, half_length_);
      return fromSphere(from_core, normal);
    }
    case Kind::Box:
      return fromBox(p, normal);
    case Kind::Cylinder:
      return fromCylinder(p, normal);
    case Kind::Other:
      break;
  }
  return byGjk(*shape_, p, normal);
}

double PointDistance::fromSphere(const Eigen::Vector3d& p, Eigen::Vector3d& normal) const {
  const double length = p.norm();
  if (length > kNoDirection)
    normal = p / length;
  else
    normal = Eigen::Vector3d::Unit((axis_ + 1) % 3);  // perpendicular to the axis of a capsule
  return length - radius_;
}

double PointDistance::fromBox(const Eigen::Vector3d& p, Eigen::Vector3d& normal) const {
  const Eigen::Vector3d beyond = p.cwiseAbs() - half_;
  const Eigen::Vector3d outside = beyond.cwiseMax(0.0);
  const double length = outside.norm();
  normal.setZero();
  if (length > kNoDirection) {
    for (int i = 0; i < 3; ++i) normal[i] = std::copysign(outside[i] / length, p[i]);
    return length;
  }
  int face = 0;
  const double depth = beyond.maxCoeff(&face);
  normal[face] = std::copysign(1.0, p[face]);
  return depth;
}

double PointDistance::fromCylinder(const Eigen::Vector3d& p, Eigen::Vector3d& normal) const {
  Eigen::Vector3d radial = p;
  radial[axis_] = 0;
  const double from_axis = radial.norm();
  if (from_axis > kNoDirection)
    radial /= from_axis;
  else
    radial = Eigen::Vector3d::Unit((axis_ + 1) % 3);
  const Eigen::Vector3d axial = Eigen::Vector3d::Unit(axis_) * std::copysign(1.0, p[axis_]);

  const double beyond_side = from_axis - radius_;
  const double beyond_end = std::abs(p[axis_]) - half_length_;
  const double side = std::max(beyond_side, 0.0);
  const double end = std::max(beyond_end, 0.0);
  const double length = std::sqrt(side * side + end * end);
  if (length > kNoDirection) {
    normal = radial * (side / length) + axial * (end / length);
    return length;
  }
  normal = beyond_side > beyond_end ? radial : axial;
  return std::max(beyond_side, beyond_end);
}

double PointDistance::byGjk(const btConvexShape& shape, const Eigen::Vector3d& p, Eigen::Vector3d& normal) {
  btVector3 lower, upper;
  shape.getAabb(btTransform::getIdentity(), lower, upper);
  // Bullet's tolerances are absolute and meant for objects of a metre: with float scalars the distance to a cylinder of
  // 1 cm had an error of 4 mm; scaled to kGjkSize it does not
  const btScalar scale = static_cast<btScalar>(kGjkSize) / (upper - lower).length();
  const btUniformScalingShape enlarged(const_cast<btConvexShape*>(&shape), scale);  // only reads it
  const Eigen::Matrix<btScalar, 3, 1> at = p.cast<btScalar>() * scale;
  btGjkEpaSolver2::sResults result;
  result.normal.setZero();
  const double distance = btGjkEpaSolver2::SignedDistance(btVector3(at.x(), at.y(), at.z()), 0, &enlarged,
                                                          btTransform::getIdentity(), result);
  normal = toEigen(result.normal);
  const double length = normal.norm();
  if (std::abs(length - 1) < 1e-3 && distance < static_cast<double>(SIMD_INFINITY)) {
    normal /= length;
    return distance / static_cast<double>(scale);
  }
  // Bullet finds no direction for a point on the surface within its accuracy; use the direction outwards from the
  // centre
  const Eigen::Vector3d outwards = p - toEigen((lower + upper) / 2);
  normal = outwards.norm() > kNoDirection ? outwards.normalized() : Eigen::Vector3d::UnitX();
  return 0;
}

namespace {

using Triangle = std::array<Eigen::Vector3d, 3>;

constexpr double kNoSeparation = 1e-12;  // a shorter vector is rounding error and has no direction [m]

struct Nearest {
  Eigen::Vector3d weight = Eigen::Vector3d::Zero();
  Eigen::Vector3d core = Eigen::Vector3d::Zero();
  Eigen::Vector3d away = Eigen::Vector3d::Zero();  // from the core to the triangle
  double distance2 = std::numeric_limits<double>::infinity();

  void offer(const Eigen::Vector3d& other_weight, const Eigen::Vector3d& other_core,
             const Eigen::Vector3d& other_away) {
    const double other = other_away.squaredNorm();
    if (!(other < distance2)) return;
    weight = other_weight, core = other_core, away = other_away, distance2 = other;
  }
};

void offerEnd(const Eigen::Vector3d& end, const Triangle& t, Nearest& nearest) {
  const TriangleFoot foot = triangleFoot(end, t[0], t[1], t[2]);
  nearest.offer(foot.weight, end, -foot.away);
}

void offerEdge(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Triangle& t, int k, Nearest& nearest) {
  const auto from = static_cast<std::size_t>(k), to = static_cast<std::size_t>((k + 1) % 3);
  const Eigen::Vector3d u = b - a, v = t[to] - t[from], r = a - t[from];
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v), ur = u.dot(r), vr = v.dot(r);
  const double across = uu * vv - uv * uv;
  double s = across > 0 ? std::clamp((uv * vr - ur * vv) / across, 0.0, 1.0) : 0;
  double e = vv > 0 ? (uv * s + vr) / vv : 0;
  if (e < 0 || e > 1 || vv == 0) {  // an edge without length is a point
    e = std::clamp(e, 0.0, 1.0);
    s = uu > 0 ? std::clamp((uv * e - ur) / uu, 0.0, 1.0) : 0;
  }
  Eigen::Vector3d weight = Eigen::Vector3d::Zero();
  weight[k] = 1 - e;
  weight[(k + 1) % 3] = e;
  const Eigen::Vector3d core = a + s * u;
  nearest.offer(weight, core, t[from] + e * v - core);
}

TriangleGap gapOf(const Nearest& nearest) {
  TriangleGap gap;
  gap.weight = nearest.weight;
  gap.core = nearest.core;
  gap.distance = std::sqrt(nearest.distance2);
  if (gap.distance > kNoSeparation)
    gap.normal = nearest.away / gap.distance;
  else
    gap.distance = 0;
  return gap;
}

// Moeller and Trumbore 1997: where the segment pierces the triangle
bool pierces(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Triangle& t, TriangleGap& gap) {
  const Eigen::Vector3d u = b - a, e1 = t[1] - t[0], e2 = t[2] - t[0], p = u.cross(e2);
  const double det = e1.dot(p);
  if (det == 0) return false;
  const Eigen::Vector3d r = a - t[0];
  const double v = r.dot(p) / det;
  if (!(v >= 0 && v <= 1)) return false;
  const Eigen::Vector3d q = r.cross(e1);
  const double w = u.dot(q) / det;
  const double s = e2.dot(q) / det;
  if (!(w >= 0 && v + w <= 1 && s >= 0 && s <= 1)) return false;
  gap.weight = {1 - v - w, v, w};
  gap.core = a + s * u;
  return true;
}

}  // namespace

TriangleGap segmentTriangleGap(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Triangle& triangle) {
  Nearest nearest;
  offerEnd(a, triangle, nearest);
  if (a != b) {
    TriangleGap crossing;
    if (pierces(a, b, triangle, crossing)) return crossing;
    offerEnd(b, triangle, nearest);
    for (int k = 0; k < 3; ++k) offerEdge(a, b, triangle, k, nearest);
  }
  return gapOf(nearest);
}

TriangleGap convexTriangleGap(const btConvexShape& shape, const Triangle& triangle) {
  btVector3 lower, upper;
  shape.getAabb(btTransform::getIdentity(), lower, upper);
  // As in byGjk(), the shape is scaled to what Bullet's tolerances are meant for.
  const double scale = kGjkSize / static_cast<double>((upper - lower).length());
  const btUniformScalingShape enlarged(const_cast<btConvexShape*>(&shape), static_cast<btScalar>(scale));
  const btTriangleShape wall(toBullet(triangle[0], scale), toBullet(triangle[1], scale), toBullet(triangle[2], scale));
  const_cast<btTriangleShape&>(wall).setMargin(0);
  btVoronoiSimplexSolver simplex;
  btGjkPairDetector detector(&enlarged, &wall, &simplex, nullptr);
  btGjkPairDetector::ClosestPointInput input;
  input.m_transformA.setIdentity();
  input.m_transformB.setIdentity();
  btPointCollector found;
  detector.getClosestPoints(input, found, nullptr);
  // Bullet gives the point on the triangle; its weights say which vertices bear the contact. Where the two cross there
  // is neither distance nor normal.
  TriangleGap gap;
  const Eigen::Vector3d at = toEigen(found.m_pointInWorld) / scale;
  const double distance = static_cast<double>(found.m_distance) / scale;
  const bool apart = found.m_hasResult && distance > 0;
  gap.weight = triangleFoot(apart ? at : toEigen((lower + upper) / 2), triangle[0], triangle[1], triangle[2]).weight;
  gap.core = gap.weight[0] * triangle[0] + gap.weight[1] * triangle[1] + gap.weight[2] * triangle[2];
  if (!apart) return gap;
  gap.distance = distance;
  gap.normal = -toEigen(found.m_normalOnBInWorld).normalized();
  gap.core -= distance * gap.normal;
  return gap;
}

}  // namespace vibe
