#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "usb_nodes.hpp"

namespace vibe::hardware {

/// An open /dev/hidraw file, through the kernel's interface alone (linux/hidraw.h). It shares no code with the driver.
class HidrawFile {
 public:
  explicit HidrawFile(const std::string& path);  ///< @throws std::runtime_error
  ~HidrawFile();
  HidrawFile(const HidrawFile&) = delete;
  HidrawFile& operator=(const HidrawFile&) = delete;

  /// Waits for an input report. @param timeout [s]  @return empty: none came in time, or the device is gone
  std::vector<std::uint8_t> read(double timeout);

  /// @return the feature report; empty: refused, see errno
  std::vector<std::uint8_t> getFeature(std::uint8_t id);

  /// @return 0 or the errno of the kernel
  int setFeature(const std::vector<std::uint8_t>& bytes);

  std::vector<std::uint8_t> reportDescriptor() const;
  int descriptor() const { return file_; }

 private:
  int file_;
};

/// Sends a command to the bridge outside the virtual machine and waits for its answer; see usb_bridge_main.cpp. Threads
/// and processes may call it at the same time.
/// @throws std::runtime_error with the bridge's error, or if it does not answer within 20 s
void tellBridge(const std::string& command);

/// A device of the bridge, as a test plugs it in and pulls it out.
class PluggedDevice {
 public:
  /// @param name  of the bridge
  PluggedDevice(std::string name, UsbName usb) : name_(std::move(name)), usb_(std::move(usb)) {}

  /// Plugs it in, if it is not, and waits for hidraw, event and js nodes. @throws std::runtime_error after 20 s
  const UsbNodes& plug();

  /// Pulls it out, if it is plugged in, and waits until the kernel has dropped it. @throws std::runtime_error after 20
  /// s
  void unplug();

  /// The same without waiting, so that several devices may come or go at once: plug() and unplug() then wait.
  void beginPlug();
  void beginUnplug();

  const std::string& name() const { return name_; }
  const UsbName& usb() const { return usb_; }

 private:
  std::string name_;
  UsbName usb_;
  KernelEvents events_;
  bool plugged_ = false;  ///< as the bridge has been told
  std::optional<UsbNodes> nodes_;
  /// The kernel polls a device only while a file of it is open, and QEMU stores up what the guest does not fetch: a
  /// reader that opens the device later would first get old reports.
  std::unique_ptr<HidrawFile> keeps_polling_;
};

/// Whether scripts/hid_kernel has started the emulated board with the firmware image.
bool imageRuns();

PluggedDevice& hapticDevice();
PluggedDevice& inputDevice();
PluggedDevice& imageDevice();  ///< the firmware image of the haptic device; only if imageRuns()
PluggedDevice& spareHapticDevice();
PluggedDevice& spareInputDevice();

}  // namespace vibe::hardware
