#pragma once

#include <algorithm>
#include <array>

#include <Eigen/Core>
#include <Eigen/Geometry>

class btConvexShape;

namespace vibe {

/// Signed distance of a point from a convex Bullet shape. For spheres, capsules, boxes and cylinders (without rounding
/// margin) it is computed in closed form in double precision from the dimensions of the Bullet shape, for every other
/// convex shape by Bullet's GJK and EPA. Refers to the shape, which must outlive this object.
class PointDistance {
 public:
  explicit PointDistance(const btConvexShape& shape);

  /// @param p       in the frame of the shape, finite [m]
  /// @param normal  unit, from the nearest point of the surface outwards; if several points are equally near (a centre,
  ///         an axis), always the same one
  /// @return distance from the surface, negative inside [m]
  double operator()(const Eigen::Vector3d& p, Eigen::Vector3d& normal) const;

  /// The general method, for any convex shape. Its error on shapes of the size of the tool is 3e-6 m, because Debian's
  /// Bullet uses single precision.
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
  double half_length_ = 0;                          // of the straight part of a capsule, of a cylinder [m]
  Eigen::Vector3d half_ = Eigen::Vector3d::Zero();  // half sides of the box [m]
};

}  // namespace vibe

class btConvexShape;

namespace vibe {

/// The nearest points of a triangle and of the core of a tool shape.
struct TriangleGap {
  Eigen::Vector3d weight = Eigen::Vector3d::Zero();  ///< barycentric, of the triangle's point
  Eigen::Vector3d core = Eigen::Vector3d::Zero();    ///< the core's point [m]
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit, from the core to the triangle; zero where they cross
  double distance = 0;                               ///< from the core; 0 where they cross [m]
};

inline Eigen::Vector3d nearestOnSegment(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& p) {
  const Eigen::Vector3d along = b - a;
  const double square = along.squaredNorm();
  return square > 0 ? a + std::clamp((p - a).dot(along) / square, 0.0, 1.0) * along : a;
}

/// Nearest points of the segment from a to b, which may be a point, and a triangle (Ericson, Real-Time Collision
/// Detection, 5.1.10). The distance is zero where the segment pierces the triangle.
TriangleGap segmentTriangleGap(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                               const std::array<Eigen::Vector3d, 3>& triangle);

/// Distance of any convex shape of Bullet from a triangle, by GJK, in the frame of the shape. Its error on shapes of
/// the size of the tool is 3e-6 m, because Debian's Bullet uses single precision. Shapes that overlap the triangle
/// count as crossing.
TriangleGap convexTriangleGap(const btConvexShape& shape, const std::array<Eigen::Vector3d, 3>& triangle);

}  // namespace vibe
