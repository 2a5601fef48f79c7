#pragma once
#include <cstdint>

namespace vibe_firmware {

/// A brushed DC motor on an H-bridge that drives its voltage, and the transmission behind it.
///
/// The bridge closes the winding whenever it does not drive it (slow decay), so that the back-EMF brakes the shaft with
/// n^2 k^2 / R at every duty. The control loop counts that as viscous friction of the axis (AxisConfig) and commands
/// the stall torque: duty = torque R / (n k U). Defaults: Faulhaber 1524T012SR, data sheet EN_1524_SR_DFF, behind a
/// capstan 10:1, on 9 V (DRV8833: 2.7 V to 10.8 V).
struct MotorDrive {
  float supply_voltage = 9.0F;       ///< U, of the bridge [V]
  float resistance = 19.8F;          ///< R, of winding and bridge [ohm]
  float torque_constant = 11.5e-3F;  ///< k [N m/A]
  float transmission = 10.0F;        ///< n, turns of the motor per turn of the axis
  float direction = 1.0F;            ///< -1: the motor is wired the other way round; 1 otherwise
};

/// Duty in [-1, 1] for a torque of the axis [N m]. NaN gives 0.
float dutyOf(const MotorDrive& drive, float torque);

/// Compare values of the two inputs of one bridge, in counts during which the input is high.
struct BridgeInputs {
  std::uint32_t first = 0;   ///< high all the time when the torque is positive [counts]
  std::uint32_t second = 0;  ///< high all the time when it is negative [counts]
};

/// Drives a bridge with the truth table of DRV8833 and DRV8871 (1 0 forward, 0 1 reverse, 1 1 brake, 0 0 coast) between
/// forward or reverse and brake, never coast: one input stays high, the other is high for 1 - |duty| of the period.
/// @param duty    in [-1, 1]
/// @param period  of the PWM [counts]
BridgeInputs slowDecay(float duty, std::uint32_t period);

}  // namespace vibe_firmware
