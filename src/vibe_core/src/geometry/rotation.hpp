#pragma once
#include <Eigen/Geometry>
#include <array>

#include "common/turn.hpp"

namespace vibe {

/// Rotation of fixed-axis roll, pitch, yaw [rad], as in URDF: about x, then y, then z of the outer frame.
inline Eigen::Matrix3d rotationFromRpy(const std::array<double, 3>& rpy) {
  return (quaternionAbout(Eigen::Vector3d::UnitZ(), rpy[2]) * quaternionAbout(Eigen::Vector3d::UnitY(), rpy[1]) *
          quaternionAbout(Eigen::Vector3d::UnitX(), rpy[0]))
      .toRotationMatrix();
}

}  // namespace vibe
