#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

#include "vibe_core/input/step_input.hpp"
#include "vibe_core/model/model.hpp"

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

/// Joint positions that bring a point of the scope tip to a target, with the viewing direction as close to the wanted
/// one as its four joints allow.
struct IkSolution {
  std::array<double, kJointCount> joints;
  double miss = 0;  ///< remaining distance [m]
  double turn = 0;  ///< angle between the tip axis and the requested direction [rad]
};
/// @param offset  of the point, in scope_tip [m]
/// @param start   current joint positions; those that do not belong to the scope are kept
IkSolution aimAt(const Model& model, const Eigen::Vector3d& point, const Eigen::Vector3d& direction,
                 const Eigen::Vector3d& offset, const std::array<double, kJointCount>& start);

/// Joint positions that bring a point of the scope tip to a target with little motion; the viewing direction is left as
/// it comes. For targets near the current position of the point: the tip's turn around its axis stays about as it is.
IkSolution reachFor(const Model& model, const Eigen::Vector3d& point, const Eigen::Vector3d& offset,
                    const std::array<double, kJointCount>& start);

/// Joints with which the tip is about where it is, turned around its own axis: the shaft turns one way, the bend the
/// other. Empty, if the bend would leave its range. [rad]
std::optional<std::array<double, kJointCount>> rolled(const Model& model, std::array<double, kJointCount> joints,
                                                      double angle);

}  // namespace vibe
