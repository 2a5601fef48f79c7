#pragma once
#include <Eigen/Geometry>

namespace vibe::hardware {

/// How a hand has turned since a reference: twist about the stylus' own axis, then swing of that axis.
struct HandRotation {
  Eigen::Vector3d angles = Eigen::Vector3d::Zero();  ///< about the axes of the hand: the twist, and the swing [rad]
  /// d angles[i] / dt = rates.col(i) . angular velocity, both in the base. So a moment m[i] on angle i is the torque
  /// rates * m on the hand (virtual work).
  Eigen::Matrix3d rates = Eigen::Matrix3d::Identity();
  double swing = 0;  ///< angle between the stylus now and at the reference; at pi the twist is undefined [rad]
};

/// Splits orientation = swing * twist * reference. A function of the orientation alone, but for whole turns: a path
/// that ends where it began leaves nothing, as long as the stylus stays away from the opposite of its reference. A
/// twist counts whole however the stylus is tilted.
/// @param hand    columns: unit vectors of the hand's axes in the base
/// @param axis    number of the hand's axis whose angle is the twist
/// @param stylus  its own axis in the moving frame; unit vector
/// @param near    the whole turns are those nearest to this twist [rad]
HandRotation rotationSince(const Eigen::Quaterniond& reference, const Eigen::Quaterniond& orientation,
                           const Eigen::Matrix3d& hand, int axis, const Eigen::Vector3d& stylus, double near);

}  // namespace vibe::hardware
