#pragma once
#include <memory>
#include <optional>
#include <string>

#include "hidraw_file.hpp"
#include "kernel_events.hpp"
#include "usb_nodes.hpp"

namespace vibe {

/// A device of the bridge, as a test plugs it in and pulls it out.
class PluggedDevice {
 public:
  PluggedDevice(std::string name, std::uint16_t product) : name_(std::move(name)), product_(product) {}

  /// Plugs it in, if it is not, and waits for hidraw, event and js nodes. @throws std::runtime_error after 20 s
  const UsbNodes& plug();

  /// Pulls it out, if it is plugged in, and waits until the kernel has dropped it. @throws std::runtime_error after 20 s
  void unplug();

  const std::string& name() const { return name_; }
  std::uint16_t product() const { return product_; }

 private:
  std::string name_;
  std::uint16_t product_;
  KernelEvents events_;
  std::optional<UsbNodes> nodes_;
  /// The kernel polls a device only while a file of it is open, and QEMU stores up what the guest does not fetch: a
  /// reader that opens the device later would first get old reports.
  std::unique_ptr<HidrawFile> keeps_polling_;
};

PluggedDevice& hapticDevice();
PluggedDevice& inputDevice();
PluggedDevice& imageDevice();  ///< the firmware image; same product as the haptic device

}  // namespace vibe
