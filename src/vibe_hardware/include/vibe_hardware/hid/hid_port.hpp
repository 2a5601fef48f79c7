#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

// HID devices, wherever they are: on USB through the kernel (hidraw), or emulated behind a local socket.

namespace vibe::hardware {

/// The device does not answer any more: unplugged, or its emulator has ended.
struct DeviceGone : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The device does not know the report, or rejects it as malformed.
struct ReportRejected : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The device is there but does not answer a request in time: its firmware hangs, or the cable is bad.
struct NoAnswer : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// One device that can be opened.
struct HidInfo {
  std::string path;                       ///< to open it: "/dev/hidraw0", or that of a socket
  std::uint16_t vendor = 0, product = 0;  ///< USB ids
  std::string serial, name;               ///< as the device states them; may be empty
};

/// An open device. Not thread-safe. Reports contain their id in byte 0.
class HidPort {
 public:
  virtual ~HidPort() = default;

  /// Waits for the next input report, in the order in which the device sent them.
  /// @param timeout  [s]; 0: does not wait
  /// @return its size; 0: none came in time
  /// @throws DeviceGone
  virtual std::size_t read(std::uint8_t* bytes, std::size_t capacity, double timeout) = 0;

  /// Gets a feature report. @return its size  @throws DeviceGone, ReportRejected, NoAnswer
  virtual std::size_t getFeature(std::uint8_t id, std::uint8_t* bytes, std::size_t capacity) = 0;

  /// Sets a feature report. @throws DeviceGone, ReportRejected, NoAnswer
  virtual void setFeature(const std::uint8_t* bytes, std::size_t size) = 0;

  /// HID report descriptor of the device; empty if the bus does not know it. @throws DeviceGone
  virtual std::vector<std::uint8_t> reportDescriptor() { return {}; }
};

/// Where devices are found.
class HidBus {
 public:
  virtual ~HidBus() = default;

  /// Devices that are there now. Cheap enough to be called every 0.2 s. @throws std::runtime_error with one sentence if
  /// the bus as such cannot be used, for example because the kernel has no hidraw.
  virtual std::vector<HidInfo> list() = 0;

  /// How a sentence ends that says that a device is not in the last list(): where it was looked for, and the remedy.
  virtual std::string remedyOfAbsence() const { return "; plug it in, it is used as soon as it appears."; }

  /// @throws DeviceGone if it is not there any more; std::runtime_error with the remedy if it may not be opened
  virtual std::unique_ptr<HidPort> open(const std::string& path) = 0;
};

}  // namespace vibe::hardware
