#pragma once
#include "vibe_firmware/core/axis.hpp"

// Conditions under which a sampled spring-damper with a quantised encoder cannot give energy to the hand.
//
// With the period T, the encoder step D, the viscous and Coulomb friction b and f_c of the hardware, the delay t_d from
// reading the encoder to the torque (t_d <= T), and the pole a of the velocity filter:
//
//   b   > s h (K T/2 + g B)      sampling; Colgate and Schenkel, J. Robotic Systems 14(1), 1997, without delay
//   f_c >= s D (K/2 + g B/T)     quantisation; Abbott and Okamura, T-RO 21(5), 2005, for B = 0
//
//   g = (1 - a) / (1 + a),  h = 1/2 + t_d/T + sqrt(1/4 + 2 t_d/T)
//
// s is the safety factor. h is 1 without delay and at least 1 + 2 t_d/T, so that b > K T (1/2 + t_d/T) + g B holds too;
// that alone is too little for a delay shorter than the period. Both conditions are sufficient, not necessary; g and h
// are derived in docs/hardware.md.

namespace vibe_firmware {

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

}  // namespace vibe_firmware
