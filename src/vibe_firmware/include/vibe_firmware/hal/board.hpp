#pragma once
#include <array>

#include "vibe_firmware/core/sample.hpp"
#include "vibe_firmware/protocol/reports.hpp"

namespace vibe_firmware {

/// What the firmware needs of a board besides USB. Each port implements it once, for both devices. No function waits
/// for anything.
class Board {
 public:
  /// Reads encoder counters, index pulses since the last call, buttons (1: pressed) and a free-running clock
  /// [us, wraps at 2^32]. Called once at the beginning of each tick, from the tick interrupt.
  virtual HapticSample sample() = 0;

  /// Sets the torque of each axis [N m], at the shaft after the transmission, with the sign of the encoder. Acts within
  /// AxisConfig::output_delay. A torque beyond what the supply can drive is limited to that. Called at the end of each
  /// tick, from the tick interrupt; not called for the input device, which has no motors.
  virtual void writeTorque(const std::array<float, kAxisCount>& torque) = 0;

  /// Restarts the hardware watchdog. Without a call for about 50 ms the board resets; the motors are off during a
  /// reset.
  virtual void feedWatchdog() = 0;

 protected:
  ~Board() = default;
};

}  // namespace vibe_firmware
