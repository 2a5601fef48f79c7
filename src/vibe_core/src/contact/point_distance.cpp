#include "contact/point_distance.hpp"

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/CollisionShapes/btUniformScalingShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpa2.h>

#include <algorithm>
#include <cmath>

#include "contact/bullet_vectors.hpp"

namespace vibe {

namespace {

constexpr double kNoDirection = 1e-15;  // a shorter vector is rounding error and has no direction [m]

}  // namespace

PointDistance::PointDistance(const btConvexShape& shape) : shape_(&shape) {
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

}  // namespace vibe
