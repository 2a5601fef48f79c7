#pragma once

#include <array>
#include <cmath>

#include <Eigen/Geometry>

#include "arithmetic/elementary.hpp"

namespace vibe {

constexpr double kPi = 3.14159265358979323846;
constexpr double kDegree = kPi / 180;  ///< [rad]

}  // namespace vibe

// Rotations with the sines and cosines of elementary.hpp. Eigen::AngleAxis, Rotation2D and Quaternion::slerp take
// theirs from the C library.

namespace vibe {

/// Rotation by `angle` [rad] about a unit vector.
inline Eigen::Quaterniond quaternionAbout(const Eigen::Vector3d& axis, double angle) {
  const Eigen::Vector3d vector = math::sin(0.5 * angle) * axis;
  return {math::cos(0.5 * angle), vector.x(), vector.y(), vector.z()};
}

/// The same as a matrix (Rodrigues' formula).
inline Eigen::Matrix3d rotationAbout(const Eigen::Vector3d& axis, double angle) {
  const double s = math::sin(angle), c = math::cos(angle);
  Eigen::Matrix3d cross;
  cross << 0, -axis.z(), axis.y(), axis.z(), 0, -axis.x(), -axis.y(), axis.x(), 0;
  return c * Eigen::Matrix3d::Identity() + s * cross + (1 - c) * (axis * axis.transpose());
}

/// Angle of the rotation from one to another, at most pi [rad]. Unit quaternions.
inline double angleBetween(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to) {
  const Eigen::Quaterniond turn = from * to.conjugate();
  return 2 * math::atan2(turn.vec().norm(), std::abs(turn.w()));
}

/// The rotation at a fraction of the way from one to another, at constant speed, by the shorter way (Shoemake 1985,
/// "Animating rotation with quaternion curves"). Unit quaternions.
inline Eigen::Quaterniond between(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to, double fraction) {
  const double aligned = from.dot(to), size = std::abs(aligned);
  double first = 1 - fraction, second = fraction;
  if (size < 1 - 1e-15) {
    const double angle = math::acos(size), sine = math::sin(angle);
    first = math::sin(first * angle) / sine, second = math::sin(second * angle) / sine;
  }
  return Eigen::Quaterniond(first * from.coeffs() + (aligned < 0 ? -second : second) * to.coeffs());
}

/// Rotation of fixed-axis roll, pitch, yaw [rad], as in URDF: about x, then y, then z of the outer frame.
inline Eigen::Matrix3d rotationFromRpy(const std::array<double, 3>& rpy) {
  return (quaternionAbout(Eigen::Vector3d::UnitZ(), rpy[2]) * quaternionAbout(Eigen::Vector3d::UnitY(), rpy[1]) *
          quaternionAbout(Eigen::Vector3d::UnitX(), rpy[0]))
      .toRotationMatrix();
}

}  // namespace vibe
