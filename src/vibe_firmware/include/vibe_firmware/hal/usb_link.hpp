#pragma once
#include <cstddef>
#include <cstdint>

#include "vibe_firmware/protocol/control_endpoint.hpp"

namespace vibe_firmware {

/// Takes the control requests that a link receives.
class ControlHandler {
 public:
  static constexpr std::size_t kMaxData = 256;  ///< bytes of a data stage in either direction

  /// As ControlEndpoint::handle(); `data` holds setup.length bytes (at most kMaxData) of a request from the host,
  /// `response` room for kMaxData bytes.
  virtual int handleControl(const UsbSetup& setup, const std::uint8_t* data, std::uint8_t* response) = 0;

  /// The host has reset the bus: the device is no longer configured.
  virtual void handleBusReset() = 0;

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
