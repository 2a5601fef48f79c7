#pragma once
#include <string>

#include "vibe_hardware/emulator/device_server.hpp"
#include "vibe_hardware/emulator/usb_host.hpp"
#include "vibe_hardware/hid/file_descriptor.hpp"

namespace vibe::hardware {

/// Hands a device to the kernel through /dev/uhid: it then has a hidraw node and is a gamepad, as if it were on USB.
/// Needs a kernel with CONFIG_UHID and the right to write to /dev/uhid. The destructor removes the device.
class UhidServer : public DeviceServer {
 public:
  /// @param device  has to live as long as the server
  /// @throws std::runtime_error with the remedy
  explicit UhidServer(UsbHost& device);
  ~UhidServer() override;

  void publish(const std::uint8_t* report, std::size_t size) override;
  void serve() override;
  std::uint64_t droppedReports() const override { return dropped_; }

 private:
  void create();
  bool writeEvent(const void* event);

  UsbHost& device_;
  FileDescriptor file_;
  std::uint64_t dropped_ = 0;
};

}  // namespace vibe::hardware
