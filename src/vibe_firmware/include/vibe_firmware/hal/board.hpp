#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "vibe_firmware/core/sample.hpp"
#include "vibe_firmware/protocol/control_endpoint.hpp"
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

/// Takes the control requests that a link receives.
class ControlHandler {
 public:
  static constexpr std::size_t kMaxData = 256;  ///< bytes of a data stage in either direction

  /// As ControlEndpoint::handle(); `data` holds setup.length bytes (at most kMaxData) of a request from the host,
  /// `response` room for kMaxData bytes.
  virtual int handleControl(const UsbSetup& setup, const std::uint8_t* data, std::uint8_t* response) = 0;

  /// The host has reset the bus: the device is no longer configured.
  virtual void handleBusReset() = 0;

  /// The host has suspended the bus, as a computer that sleeps does: it sends no parameters and reads no reports.
  virtual void handleSuspend() = 0;

 protected:
  ~ControlHandler() = default;
};

/// The USB device controller of a board, or what stands in for it. Called from the main loop only.
class UsbLink {
 public:
  /// Passes on what the host has sent since the last call. Returns at once if there is nothing.
  virtual void poll(ControlHandler& handler) = 0;

  /// Offers an input report to the interrupt endpoint. @return false: the endpoint is busy, the report is dropped
  virtual bool sendReport(const std::uint8_t* bytes, std::size_t size) = 0;

 protected:
  ~UsbLink() = default;
};

}  // namespace vibe_firmware
