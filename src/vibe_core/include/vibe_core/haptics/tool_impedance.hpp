#pragma once

#include <Eigen/Core>
#include <array>

#include "vibe_core/input/step_input.hpp"

namespace vibe {

/// Impedance of the tissue at one joint of the scope while the others are held. Units: m and N for insertion, rad and
/// N m for the other joints.
struct JointResponse {
  double position = 0;     ///< of the joint at which `effort` was measured [m], [rad]
  double velocity = 0;     ///< [m/s], [rad/s]
  double effort = 0;       ///< of the tissue on the joint [N], [N m]
  double stiffness = 0;    ///< [N/m], [N m/rad]
  double damping = 0;      ///< [N s/m], [N m s/rad]
  double equilibrium = 0;  ///< position without effort at rest; `position` if there is no stiffness [m], [rad]
};

/// Mechanical impedance of the tissue at the tool that touches or holds it: what a haptic device needs to render the
/// tissue by itself until the next frame, as
///   F(x, v) = force - stiffness (x - position) - damping (v - velocity),
/// which is stiffness (equilibrium - x) - damping v wherever the stiffness has full rank. World frame, at scope_tip;
/// the tool translates without turning (3-vectors) or one joint moves (JointResponse).
///
/// The stiffness is the static one, as felt in slow motion: that of the tissue (with its foundation, its gas and all
/// that is held or touched) at an earlier state. Within one frame the resistance is higher by half or more, by inertia.
/// Rows that count: what the helix holds; contacts that stick, in three directions; contacts that slide, in the
/// direction of their normal. Along the latest motion of the tool the stiffness is corrected to the slope that the
/// forces of the last frames had, since the tissue's stiffness is known as a positive semidefinite approximation only.
/// The damping is that of the wall (stiffness_damping times the stiffness) and of its surroundings (mass_damping times
/// the mass that moves along in slow motion: Guyan 1965, doi 10.2514/3.2874).
///
/// Limits: the force itself is that of the step (where contacts make it jump to and fro, the mean of two), its slope
/// good to some 20 %, until 0.25 s after the tool has come near tissue only to a factor of two, since the stiffness at
/// rest is used until then. The tangential force of sliding contacts is in `force`, but not in the spring. Stiffness
/// from the turning of forces with the tool is left out. Implicit solver only.
struct ToolImpedance {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();   ///< of scope_tip at which `force` was measured [m]
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();   ///< of scope_tip [m/s]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();      ///< tissue on tool [N]
  Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();  ///< symmetric, positive semidefinite [N/m]
  Eigen::Matrix3d damping = Eigen::Matrix3d::Zero();    ///< symmetric, positive semidefinite [N s/m]
  /// Position of scope_tip without force at rest; along directions without stiffness that of `position` [m].
  Eigen::Vector3d equilibrium = Eigen::Vector3d::Zero();
  std::array<JointResponse, kScopeJointCount> joints;  ///< in the order of vibe::Joint
};

}  // namespace vibe
