#pragma once
#include "vibe_firmware/protocol/hid_function.hpp"

namespace vibe_firmware {

/// Setup stage of a USB control transfer (USB 2.0, table 9-2).
struct UsbSetup {
  std::uint8_t request_type = 0;
  std::uint8_t request = 0;
  std::uint16_t value = 0;
  std::uint16_t index = 0;
  std::uint16_t length = 0;
};

/// Answers control requests of the host: standard requests (USB 2.0, chapter 9) and those of the HID class (HID 1.11,
/// chapter 7). Independent of any controller: a port feeds it with the setup packets of its hardware, an emulator with
/// those of a socket.
class ControlEndpoint {
 public:
  static constexpr int kStall = -1;

  explicit ControlEndpoint(HidFunction& function) : function_(function) {}

  /// @param data      of the data stage from the host, setup.length bytes; unused for requests to the host
  /// @param response  of the data stage to the host
  /// @return bytes of the response, never more than setup.length or capacity; kStall: the request is not understood
  int handle(const UsbSetup& setup, const std::uint8_t* data, std::uint8_t* response, std::size_t capacity);

  bool configured() const { return configuration_ != 0; }

 private:
  HidFunction& function_;
  std::uint8_t configuration_ = 0;
  std::uint8_t idle_rate_ = 0;
};

}  // namespace vibe_firmware
