#pragma once
#include <Eigen/Core>

namespace vibe::rviz_plugins {

/// How bleeding is drawn. The shape depends on the message, its time and the wall of that time alone.
struct BloodStyle {
  Eigen::Vector3d down{-1, 0, 0};  ///< direction of gravity, unit; default: patient in supine position
  double emphasis = 1;             ///< factor for the thickness of jets and drops
  double time = 0;                 ///< of the message; phase of the pulse of brisk bleeding [s]
};

}  // namespace vibe::rviz_plugins
