#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

// One axis of the haptic device as the control loop sees it: a shaft with an encoder and a motor, after its
// transmission. Angles [rad], torques [N m]. A slide that runs over a roller is the same with its radius, which only
// the host knows.

namespace vibe_firmware {

constexpr int kAxisCount = 2;  ///< insertion and rotation, or tip up/down and left/right

/// Counts that a float represents exactly. An axis that leaves this range has an encoder fault.
constexpr std::int32_t kMaxCount = 1 << 24;

/// What the hardware of an axis is. Compiled into the firmware of a device: nobody on the bus can change it.
struct AxisConfig {
  float sample_period = 1e-3F;         ///< T, of the control loop [s]
  float radians_per_count = 3.07e-4F;  ///< D, after the transmission; 4 counts per encoder line [rad]; sign: direction
  float full_scale = 6.2832F;          ///< position that the gamepad axis shows as 32767 [rad]
  float viscous_friction = 6.7e-4F;    ///< b, motor back-EMF damping included [N m s/rad]
  float coulomb_friction = 8e-4F;      ///< f_c [N m]
  float torque_limit = 0.029F;         ///< that the motor can hold for ever [N m]
  float slew_limit = 10.0F;         ///< of torque changes that the hand does not cause: see step() of an axis [N m/s]
  float velocity_pole = 0.9F;       ///< a, of the velocity filter v = a v + (1-a) dx/T; in [0, 1)
  float output_delay = 0.05e-3F;    ///< t_d, from reading the encoder to the torque; at most T [s]
  float safety_factor = 1.25F;      ///< of both passivity conditions, at least 1
  float energy_capacity = 0.05F;    ///< that the passivity observer lets the axis give back at most [J]
  float speed_limit = 100.0F;       ///< that the axis cannot exceed; beyond it: encoder fault [rad/s]
  float counts_per_turn = 2048.0F;  ///< between two index pulses; 0: the encoder has no index
};
constexpr std::size_t kAxisConfigFields = 13;  ///< all float, in the order above
static_assert(sizeof(AxisConfig) == kAxisConfigFields * sizeof(float), "kAxisConfigFields");

/// What the host asks of an axis: torque = torque_at_position - stiffness (x - position) - damping v. A spring about an
/// equilibrium is torque 0 and position the equilibrium.
struct AxisParameters {
  float stiffness = 0;     ///< K [N m/rad], at least 0
  float damping = 0;       ///< B [N m s/rad], at least 0
  float position = 0;      ///< x0, where `torque` is the static torque [rad]
  float torque = 0;        ///< there [N m]
  float torque_limit = 0;  ///< on the sum, from 0 to that of the axis [N m]
};

/// Why parameters are refused.
enum class Refusal : std::uint8_t {
  None,
  NotFinite,        ///< a value is NaN or infinite
  Negative,         ///< stiffness, damping or torque limit below 0
  TorqueLimit,      ///< torque limit or torque above that of the axis
  ViscousFriction,  ///< b > h (K T/2 + g B) fails: stiffness or damping too high for the viscous friction
  CoulombFriction,  ///< f_c >= D (K/2 + (1 - a) B/T) fails: too high for the Coulomb friction
  Position,         ///< beyond kMaxCount encoder counts
};

/// Result of checking parameters: value and limit are those of the condition that failed.
struct Verdict {
  Refusal refusal = Refusal::None;  ///< None: the parameters are accepted
  std::uint8_t axis = 0;            ///< that was refused, 0 or 1
  float value = 0;                  ///< that was asked for, in the unit of the parameter
  float limit = 0;                  ///< that it must keep, in the same unit
};

}  // namespace vibe_firmware
