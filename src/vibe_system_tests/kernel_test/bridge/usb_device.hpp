#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>

#include "vibe_firmware/protocol/control_endpoint.hpp"

namespace vibe::hardware {

/// A device on a bus without a bus: answers control requests and hands out input reports. Used from one thread.
class UsbDevice {
 public:
  using ReportSink = std::function<void(const std::uint8_t* bytes, std::size_t size)>;

  virtual ~UsbDevice() = default;

  /// Answers a control request.
  /// @param data  of the data stage from the host, setup.length bytes
  /// @return bytes of the response; vibe_firmware::ControlEndpoint::kStall: the device does not understand it
  virtual int control(const vibe_firmware::UsbSetup& setup, const std::uint8_t* data, std::uint8_t* response,
                      std::size_t capacity) = 0;

  /// The bus has been reset.
  virtual void reset() = 0;

  /// Becomes readable when service() has something to do.
  virtual int descriptor() const = 0;

  /// Does what is due and gives the sink every input report that it makes, in order.
  virtual void service(const ReportSink& sink) = 0;
};

}  // namespace vibe::hardware
