#pragma once
#include <LinearMath/btVector3.h>

#include <Eigen/Core>

namespace vibe {

/// Diagonal to which a shape is scaled for Bullet's GJK, whose margins and tolerances are absolute: a tool shape of 1
/// cm had an error of 4 mm; scaled it does not [Bullet's units].
constexpr double kGjkSize = 100;

inline Eigen::Vector3d toEigen(const btVector3& v) {
  return {v.x(), v.y(), v.z()};
}

/// @param scale  factor on all coordinates [1]
inline btVector3 toBullet(const Eigen::Vector3d& p, double scale) {
  return {static_cast<btScalar>(scale * p.x()), static_cast<btScalar>(scale * p.y()),
          static_cast<btScalar>(scale * p.z())};
}

}  // namespace vibe
