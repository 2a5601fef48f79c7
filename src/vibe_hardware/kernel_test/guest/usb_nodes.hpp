#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace vibe {

/// The files that the kernel has made for one USB device.
struct UsbNodes {
  std::string hidraw;      ///< "/dev/hidraw0"
  std::string event, joy;  ///< "/dev/input/event0", "/dev/input/js0"
  std::string usb;         ///< folder of the USB device in /sys
};

/// Looks for the device with this product id of the project's vendor id. Without a value until all nodes are there.
std::optional<UsbNodes> findUsbNodes(std::uint16_t product);

/// Whether the kernel still knows a HID device with this product id.
bool isKnown(std::uint16_t product);

/// Text of a file in /sys without the line end; empty: there is none.
std::string readAttribute(const std::string& path);

}  // namespace vibe
