#pragma once
#include "diagnostics.hpp"
#include "vibe_firmware/hal/board.hpp"

namespace vibe_firmware::stm32 {

/// The link of an image that was built without a USB stack: nobody calls, and the serial port says so.
class NoUsbLink : public UsbLink {
 public:
  explicit NoUsbLink(Diagnostics& diagnostics) { diagnostics.write("no USB: built without TINYUSB_DIR\r\n"); }
  void poll(ControlHandler&) override {}
  bool sendReport(const std::uint8_t*, std::size_t) override { return false; }
};

}  // namespace vibe_firmware::stm32
