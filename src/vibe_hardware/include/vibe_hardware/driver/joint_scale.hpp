#pragma once

#include "vibe_firmware/core/axis.hpp"

namespace vibe::hardware {

/// How a joint of the scope follows from an axis of a device: joint = offset + scale * axis.
/// scale: [m/rad] for insertion (radius of the roller), [rad/rad] otherwise; its sign is the direction; not 0.
struct JointScale {
  double scale = 1;   ///< [m/rad] or [rad/rad]
  double offset = 0;  ///< joint where the axis is at 0 [m], [rad]
};

/// Spring-damper: effort - stiffness (x - position) - damping (v - velocity). In the units of a joint ([m] or [rad],
/// [N] or [N m]), or of an axis ([rad], [N m]).
struct JointSpring {
  double position = 0;   ///< where the effort is `effort`, at `velocity` [m], [rad]
  double effort = 0;     ///< there, positive in the direction of growing x [N], [N m]
  double stiffness = 0;  ///< [N/m], [N m/rad]
  double damping = 0;    ///< [N s/m], [N m s/rad]
  double velocity = 0;   ///< at which the damper gives nothing [m/s], [rad/s]
};

double jointPosition(const JointScale& joint, double axis_position);  ///< [rad] to [m] or [rad]; nothing is limited
double axisPosition(const JointScale& joint, double joint_position);  ///< its inverse: [m] or [rad] to [rad]
double jointEffort(const JointScale& joint, double axis_torque);      ///< by virtual work: [N m] to [N] or [N m]

/// The same spring-damper on the axis. Virtual work makes torque = scale * effort, so that power is the same on both
/// sides; stiffness and damping scale by scale^2.
JointSpring springOnAxis(const JointScale& joint, const JointSpring& spring);

/// The same as the device takes it, with the damping about velocity 0: torque += damping * velocity. Nothing is limited
/// but the torque: see passiveSpring().
/// @param torque_limit  of the axis [N m]
vibe_firmware::AxisParameters axisSpring(const JointScale& joint, const JointSpring& spring, double torque_limit);

/// The nearest spring-damper that an axis accepts.
struct PassiveSpring {
  vibe_firmware::AxisParameters parameters;  ///< as the device takes them, with the torque limit of the axis
  bool clamped = false;  ///< stiffness or damping is lower than asked, or a torque is beyond the motor
};

/// Lowers stiffness and damping to what is passive on this axis (vibe_firmware/core/passivity.hpp), so that the device
/// does not refuse the set. Stiffness has priority, because it decides which force is felt; damping gets the rest.
/// Where the torque at the position is above the limit of the motor, the same spring is stated about the position where
/// the torque equals the limit.
/// @param spring  in units of the axis, finite; stiffness and damping at least 0
PassiveSpring passiveSpring(const vibe_firmware::AxisConfig& axis, const JointSpring& spring);

}  // namespace vibe::hardware
