#pragma once
#include "vibe_firmware/core/axis.hpp"
#include "vibe_firmware/core/energy_account.hpp"

// Second barrier behind the passivity conditions: an observer of the energy that the motor gives to the hand, and a
// controller that takes torque away before the energy runs out (time-domain passivity; Hannaford and Ryu, IEEE
// Transactions on Robotics and Automation 18(1), 2002). It also covers what the conditions do not: parameters that
// change. Whatever the host sends, an axis gives the hand no more than AxisConfig::energy_capacity beyond what the hand
// has put in since.

namespace vibe_firmware {

/// Books one period: the torque that was held, times the motion that was measured [N m, rad].
void observe(const AxisConfig& config, float torque, float motion, EnergyAccount& energy);

/// Books a torque change that the hand did not cause. The hand may be half an encoder step beside the measured
/// position: the observer cannot see the energy |change| D / 2.
void observeChange(const AxisConfig& config, float change, EnergyAccount& energy);

/// What the controller lets through.
struct PassivityLimit {
  float spring = 0;   ///< torque of the spring [N m]
  float damping = 0;  ///< B [N m s/rad]
  float torque = 0;   ///< limit on the sum [N m]
  bool acts = false;
};

/// Limits so that the energy lasts for one period at AxisConfig::speed_limit, whatever the hand does. One tenth of the
/// capacity is reserved for damping; where the spring is reduced, the largest passive damping replaces it, which takes
/// energy from the hand and so fills the account again.
PassivityLimit limit(const AxisConfig& config, float spring, float damping, float torque_limit,
                     const EnergyAccount& energy);

}  // namespace vibe_firmware
