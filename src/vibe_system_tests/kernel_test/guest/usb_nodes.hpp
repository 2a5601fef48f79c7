#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace vibe::hardware {

/// What tells one device from another; the vendor id is always the project's.
struct UsbName {
  std::uint16_t product;
  std::string serial;
};

/// The files that the kernel has made for one USB device.
struct UsbNodes {
  std::string hidraw;      ///< "/dev/hidraw0"
  std::string event, joy;  ///< "/dev/input/event0", "/dev/input/js0"
  std::string usb;         ///< folder of the USB device in /sys
};

/// Looks for a device. Without a value until all nodes are there.
std::optional<UsbNodes> findUsbNodes(const UsbName& name);

/// Whether the kernel still knows this HID device.
bool isKnown(const UsbName& name);

/// Text of a file in /sys without the line end; empty: there is none.
std::string readAttribute(const std::string& path);

/// What the kernel tells about devices that come and go (netlink, as udev listens to it).
class KernelEvents {
 public:
  KernelEvents();  ///< @throws std::runtime_error
  ~KernelEvents();
  KernelEvents(const KernelEvents&) = delete;
  KernelEvents& operator=(const KernelEvents&) = delete;

  /// Checks the condition now and after every event.
  /// @param timeout  [s]
  /// @return whether it became true in time
  bool waitUntil(const std::function<bool()>& condition, double timeout);

 private:
  int socket_;
};

}  // namespace vibe::hardware
