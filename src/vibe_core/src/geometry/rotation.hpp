#pragma once
#include <Eigen/Geometry>
#include <array>

namespace vibe {

/// Rotation of fixed-axis roll, pitch, yaw [rad], as in URDF: about x, then y, then z of the outer frame.
inline Eigen::Matrix3d rotationFromRpy(const std::array<double, 3>& rpy) {
  return (Eigen::AngleAxisd(rpy[2], Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(rpy[1], Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(rpy[0], Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

}  // namespace vibe
