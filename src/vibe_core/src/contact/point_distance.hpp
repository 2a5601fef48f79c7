#pragma once
#include <Eigen/Core>

class btConvexShape;

namespace vibe {

/// Signed distance of a point from a convex Bullet shape. Spheres, capsules, boxes and cylinders (without rounding
/// margin) are measured in closed form in double precision from the Bullet shape's dimensions; every other convex
/// shape by Bullet's GJK and EPA. Refers to the shape, which must outlive it.
class PointDistance {
 public:
  explicit PointDistance(const btConvexShape& shape);

  /// @param p       in the shape's frame, finite [m]
  /// @param normal  unit, from the nearest point of the surface outwards; where several are equally near (a centre, an
  ///                axis) one of them, always the same
  /// @return distance from the surface, negative inside [m]
  double operator()(const Eigen::Vector3d& p, Eigen::Vector3d& normal) const;

  /// The general route, for any convex shape. Its error on shapes of the tool's size is 3e-6 m, because Debian's Bullet
  /// calculates with floats.
  static double byGjk(const btConvexShape& shape, const Eigen::Vector3d& p, Eigen::Vector3d& normal);

 private:
  enum class Kind { Sphere, Capsule, Box, Cylinder, Other };

  double fromSphere(const Eigen::Vector3d& p, Eigen::Vector3d& normal) const;
  double fromBox(const Eigen::Vector3d& p, Eigen::Vector3d& normal) const;
  double fromCylinder(const Eigen::Vector3d& p, Eigen::Vector3d& normal) const;

  const btConvexShape* shape_;
  Kind kind_ = Kind::Other;
  int axis_ = 2;                                    // of capsule and cylinder: 0 x, 1 y, 2 z
  double radius_ = 0;                               // of sphere, capsule, cylinder [m]
  double half_length_ = 0;                          // of the capsule's straight part, of the cylinder [m]
  Eigen::Vector3d half_ = Eigen::Vector3d::Zero();  // half sides of the box [m]
};

}  // namespace vibe
