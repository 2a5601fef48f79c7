#pragma once
#include "vibe_firmware/core/axis.hpp"

namespace vibe {

/// How a joint of the scope follows from an axis of a device: joint = offset + scale * axis.
/// scale: [m/rad] for insertion (radius of the roller), [rad/rad] otherwise; its sign is the direction.
struct JointScale {
  double scale = 1;
  double offset = 0;
};

/// Spring-damper of a joint: effort = effort - stiffness (x - position) - damping v, in the units of the joint.
struct JointSpring {
  double position = 0;   ///< [m], [rad]
  double effort = 0;     ///< [N], [N m]
  double stiffness = 0;  ///< [N/m], [N m/rad]
  double damping = 0;    ///< [N s/m], [N m s/rad]
};

double jointPosition(const JointScale& joint, double axis_position);
double axisPosition(const JointScale& joint, double joint_position);
double jointEffort(const JointScale& joint, double axis_torque);

/// The same spring on the axis: virtual work makes torque = scale * effort, stiffness and damping scale by scale^2.
/// @param torque_limit  of the axis [N m]
vibe_firmware::AxisParameters axisSpring(const JointScale& joint, const JointSpring& spring, double torque_limit);

}  // namespace vibe
