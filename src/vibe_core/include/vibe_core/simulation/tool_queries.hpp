#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "vibe_core/input/step_input.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

/// Pose of scope_tip in world.
/// @param model  with a tool
Eigen::Isometry3d tipPose(const Model& model, const State& state);

/// Rows: linear velocity of the origin of scope_tip, angular velocity of the link, both in world. Columns: the joints
/// of the scope in the order of vibe::Joint. Units [m/m], [m/rad], [rad/m], [rad/rad].
using TipJacobian = Eigen::Matrix<double, 6, kScopeJointCount>;

/// How the tip moves with the joints of the hand, while the displacement of a scope that gives way stays as it is.
/// @param model  with a tool
TipJacobian tipJacobian(const Model& model, const State& state);

/// The place of the wall that the scope looks at.
struct WallSight {
  int triangle = -1;       ///< of the organ's surface
  Eigen::Vector3d point;   ///< on the mid-surface of the wall, in world [m]
  Eigen::Vector3d normal;  ///< of the triangle, to the side of the scope; unit, in world
  double distance = 0;     ///< from the origin of scope_tip along its x axis; below 0: the tip is pressed in [m]
};

/// The farthest place that lookAhead() finds [m].
constexpr double kSightReach = 0.5;

/// Where the x axis of scope_tip meets the wall first; empty if it does not within kSightReach. Other parts of the tool
/// are transparent. Where the tip is pressed in, the search begins half a wall's thickness behind it.
/// @param model  with a tool
std::optional<WallSight> lookAhead(const Model& model, const State& state);

/// Position of a joint that only a picture needs.
struct DrawnJoint {
  std::string name;     ///< as in the URDF
  double position = 0;  ///< [m], [rad]
};

/// Where the parts of the suturing device are that the simulation has no joints for, as far as the URDF has them:
///   needle_arm_hinge, needle_hook_turn    the arm turns about its hinge and the hook about the needle's point, so that
///                                         they stay joined (links needle_arm_pin and needle_hook_pin)
///   needle_slide, needle_turn, needle_draw  the needle: on the hook, in the anchor exchange, or gone as T-tag
///   argon_probe                           the end of the probe before the distal face: marking.probe_length while the
///                                         pedal is down, else the offset of its mimic element
/// In the URDF they mimic needle_driver; what is told here comes first. Follows from model and state alone.
/// @param model  with a tool
std::vector<DrawnJoint> drawnJoints(const Model& model, const State& state);

/// Pose of every link in world with the joints that only a picture needs, in link order.
/// @param model  with a tool
std::vector<Eigen::Isometry3d> drawnLinkPoses(const Model& model, const State& state);

}  // namespace vibe
