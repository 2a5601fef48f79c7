#pragma once

#include <Eigen/Core>
#include <array>

#include "vibe_core/input/step_input.hpp"

namespace vibe {

/// How the tissue answers a small motion of one joint of the scope, the others held. Units: m and N for insertion, rad
/// and N m for the rest.
struct JointResponse {
  double position = 0;     ///< of the joint where `effort` holds [m], [rad]
  double velocity = 0;     ///< [m/s], [rad/s]
  double effort = 0;       ///< of the tissue on the joint [N], [N m]
  double stiffness = 0;    ///< [N/m], [N m/rad]
  double damping = 0;      ///< [N s/m], [N m s/rad]
  double equilibrium = 0;  ///< where the effort would vanish at rest; `position` where there is no stiffness [m], [rad]
};

/// How the tissue answers a small motion of the tool that touches or holds it: what a device needs to render the tissue
/// by itself until the next frame, as
///   F(x, v) = force - stiffness (x - position) - damping (v - velocity),
/// which is stiffness (equilibrium - x) - damping v wherever the stiffness has full rank. World frame, at scope_tip;
/// the tool translates without turning (3-vectors) or one joint moves (JointResponse).
///
/// The stiffness is the static one, as a slow hand feels it: that of the tissue (with its foundation, its gas and all
/// that is held or touched) about an earlier state, not the resistance within one frame, in which the inertia of the
/// tissue adds half and more. Rows that count: what the helix holds; contacts that stick, in three directions; contacts
/// that slide, in the direction of their normal. Along the latest motion of the tool the stiffness is corrected to the
/// slope that the forces of the last frames had, since the tissue's stiffness is known as a positive semidefinite
/// approximation only. The damping is that of the wall (stiffness_damping times the stiffness) and of its surroundings
/// (mass_damping times the mass that moves along with the tool in slow motion: Guyan 1965, doi 10.2514/3.2874).
///
/// Limits: the force itself is that of the step (where contacts make it jump to and fro, the mean of two), its slope
/// good to some 20 %, until 0.25 s after the tool has come near tissue only to a factor of two, since the stiffness at
/// rest is used until then. The tangential force of sliding contacts is in `force`, but not in the spring. Stiffness
/// from the turning of forces with the tool is left out. Implicit solver only.
struct ToolImpedance {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();   ///< of scope_tip where `force` holds [m]
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();   ///< of scope_tip [m/s]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();      ///< tissue on tool [N]
  Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();  ///< symmetric, positive semidefinite [N/m]
  Eigen::Matrix3d damping = Eigen::Matrix3d::Zero();    ///< symmetric, positive semidefinite [N s/m]
  /// Where scope_tip would be free of force at rest; along directions without stiffness it is where it is [m].
  Eigen::Vector3d equilibrium = Eigen::Vector3d::Zero();
  std::array<JointResponse, kScopeJointCount> joints;  ///< in the order of vibe::Joint
};

}  // namespace vibe
