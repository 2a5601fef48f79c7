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
/// those of a socket. The port itself stores the address of SET_ADDRESS, which is only acknowledged here, and calls
/// reset() after a bus reset.
class ControlEndpoint {
 public:
  static constexpr int kStall = -1;

  explicit ControlEndpoint(HidFunction& function) : function_(function) {}

  /// @param data      of the data stage from the host, setup.length bytes; unused for requests to the host
  /// @param response  of the data stage to the host
  /// @return bytes of the response, never more than setup.length or capacity; kStall: the request is not understood
  int handle(const UsbSetup& setup, const std::uint8_t* data, std::uint8_t* response, std::size_t capacity);

  /// Back to the state after power-up.
  void reset();

  /// Input reports may be sent.
  bool configured() const { return configuration_ != 0; }

  /// The host has halted the interrupt endpoint: it must answer STALL.
  bool halted() const { return halted_; }

 private:
  int standardDevice(const UsbSetup& setup, std::uint8_t* response, std::size_t capacity);
  int standardInterface(const UsbSetup& setup, std::uint8_t* response, std::size_t capacity);
  int standardEndpoint(const UsbSetup& setup, std::uint8_t* response, std::size_t capacity);
  int classInterface(const UsbSetup& setup, const std::uint8_t* data, std::uint8_t* response, std::size_t capacity);
  int descriptor(const UsbSetup& setup, std::uint8_t* response, std::size_t capacity) const;
  int string(const UsbSetup& setup, std::uint8_t* response, std::size_t capacity) const;

  HidFunction& function_;
  std::uint8_t configuration_ = 0;
  std::uint8_t idle_rate_ = 0;  // unit 4 ms; 0: no repetition. Kept for the host only: reports come every 10 ms anyway
  bool halted_ = false;
};

}  // namespace vibe_firmware
