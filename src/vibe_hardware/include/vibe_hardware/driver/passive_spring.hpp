#pragma once
#include "vibe_firmware/core/axis.hpp"
#include "vibe_hardware/driver/joint_scale.hpp"

namespace vibe::hardware {

/// The nearest spring-damper that an axis accepts.
struct PassiveSpring {
  vibe_firmware::AxisParameters parameters;
  bool clamped = false;  ///< stiffness or damping is lower than asked, or a torque is beyond the motor
};

/// Lowers stiffness and damping to what is passive on this axis (vibe_firmware/core/passivity.hpp), so that the device
/// does not refuse the set. Stiffness has priority, because it decides which force is felt; damping gets the rest.
/// Where the torque at the position is above the limit of the motor, the same spring is stated about the position where
/// the torque equals the limit.
/// @param spring  in units of the axis, finite; stiffness and damping at least 0
PassiveSpring passiveSpring(const vibe_firmware::AxisConfig& axis, const JointSpring& spring);

}  // namespace vibe::hardware
