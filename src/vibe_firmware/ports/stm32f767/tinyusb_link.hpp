#pragma once
#include "diagnostics.hpp"
#include "vibe_firmware/hal/board.hpp"

namespace vibe_firmware::stm32 {

/// OTG_FS through TinyUSB. There is one. Descriptors and reports come from the handler; TinyUSB itself answers the
/// other standard requests. A report that is set and malformed stalls.
///
/// This port has never run on hardware.
class TinyUsbLink : public UsbLink {
 public:
  explicit TinyUsbLink(Diagnostics& diagnostics);
  void poll(ControlHandler& handler) override;
  bool sendReport(const std::uint8_t* bytes, std::size_t size) override;

 private:
  bool started_ = false;
};

}  // namespace vibe_firmware::stm32
