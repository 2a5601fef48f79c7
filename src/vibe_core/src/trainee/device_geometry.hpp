#pragma once
#include <Eigen/Core>

namespace vibe {

// The device as its operator knows it; see the URDF of the endoscope.

constexpr double kHelixOut = 26e-3;     ///< helix_advance with which it goes to the wall [m]
constexpr double kFullyDrawn = 1e-3;    ///< and at which the wall is in the device [m]
constexpr double kHelixDepth = 1.5e-3;  ///< into the wall, so that it is surely in reach [m]

/// Tip of the helix in scope_tip [m].
inline Eigen::Vector3d helixInTip(double helix_advance) {
  return {helix_advance - 2e-3, 2.8e-3, -2.2e-3};
}

/// Point of the needle with the arm open, in scope_tip [m].
inline Eigen::Vector3d openNeedleInTip() {
  return {14.8e-3, -2.5e-3, 13.4e-3};
}

}  // namespace vibe
