#pragma once

#include "vibe_firmware/core/axis.hpp"

namespace vibe_firmware {

/// Energy that an axis may still give to the hand [J]: what it has given is taken off, what the hand has put in is
/// added, up to a capacity. Sums with compensation (Knuth's two-sum), so that a million small amounts do not get lost.
struct EnergyAccount {
  float balance = 0;  ///< at most the capacity of the axis
  float error = 0;    ///< that rounding has left out of `balance`

  /// @param capacity  upper limit of the balance [J]
  void add(float energy, float capacity);
};

// Conditions under which a sampled spring-damper with a quantised encoder cannot give energy to the hand.
//
// With the period T, the encoder step D, the viscous and Coulomb friction b and f_c of the hardware, the delay t_d from
// reading the encoder to the torque (t_d <= T), and the pole a of the velocity filter:
//
//   b   > s h (K T/2 + g B)      sampling; Colgate and Schenkel, J. Robotic Systems 14(1), 1997, without delay
//   f_c >= s D (K/2 + (1 - a) B/T)  quantisation; Abbott and Okamura, T-RO 21(5), 2005, for B = 0
//
//   g = (1 - a) / (1 + a),  h = 1/2 + t_d/T + sqrt(1/4 + 2 t_d/T)
//
// s is the safety factor. h is 1 without delay and at least 1 + 2 t_d/T, so that b > K T (1/2 + t_d/T) + g B holds too;
// that alone is too little for a delay shorter than the period. Both conditions are sufficient, not necessary; g, h and
// the error of the filtered velocity are derived in docs/hardware.md.

/// Viscous friction that the hardware needs [N m s/rad], safety factor included.
float requiredViscousFriction(const AxisConfig& config, float stiffness, float damping);

/// Coulomb friction that the hardware needs [N m], safety factor included.
float requiredCoulombFriction(const AxisConfig& config, float stiffness, float damping);

/// Largest stiffness [N m/rad] that is passive together with this damping; 0 if none is.
float maxStiffness(const AxisConfig& config, float damping);

/// Largest damping [N m s/rad] that is passive together with this stiffness; 0 if none is.
float maxDamping(const AxisConfig& config, float stiffness);

/// Checks the parameters of one axis. `verdict.axis` is left 0.
Verdict validate(const AxisConfig& config, const AxisParameters& parameters);

/// Checks both axes; the first refusal counts. All or nothing: a set is never applied in part.
Verdict validate(const std::array<AxisConfig, kAxisCount>& configs,
                 const std::array<AxisParameters, kAxisCount>& parameters);

// Second barrier behind the passivity conditions: an observer of the energy that the motor gives to the hand, and a
// controller that takes torque away before the energy runs out (time-domain passivity; Hannaford and Ryu, IEEE
// Transactions on Robotics and Automation 18(1), 2002). It also covers what the conditions do not: parameters that
// change. Whatever the host sends, an axis gives the hand no more than AxisConfig::energy_capacity beyond what the hand
// has put in since.

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
  bool acts = false;  ///< the spring or the limit on the sum is lower than asked
};

/// Limits so that the energy lasts for one period at AxisConfig::speed_limit, whatever the hand does. One tenth of the
/// capacity is reserved for damping; where the spring is reduced, the largest passive damping replaces it, which takes
/// energy from the hand and so fills the account again.
PassivityLimit limit(const AxisConfig& config, float spring, float damping, float torque_limit,
                     const EnergyAccount& energy);

}  // namespace vibe_firmware
