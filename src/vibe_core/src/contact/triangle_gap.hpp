#pragma once
#include <Eigen/Geometry>
#include <algorithm>
#include <array>

class btConvexShape;

namespace vibe {

/// The nearest points of a triangle and of the core of a tool shape.
struct TriangleGap {
  Eigen::Vector3d weight = Eigen::Vector3d::Zero();  ///< barycentric, of the triangle's point [1]
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

/// The same for any convex shape of Bullet, by GJK, in the frame of the shape. Its error on shapes of the size of the
/// tool is 3e-6 m, because Debian's Bullet uses single precision. Shapes that overlap the triangle count as crossing.
TriangleGap convexTriangleGap(const btConvexShape& shape, const std::array<Eigen::Vector3d, 3>& triangle);

}  // namespace vibe
