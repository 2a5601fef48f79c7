#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vibe::hardware {

/// Size of one report, its id included if the device numbers its reports.
struct ReportSize {
  /// Input comes from the device, Output goes to it; a Feature is read and set on request.
  enum class Kind : std::uint8_t { Input, Output, Feature };

  Kind kind = Kind::Input;  ///< direction of the report
  std::uint8_t id = 0;      ///< 0: the device does not number its reports
  std::size_t bytes = 0;    ///< its length
};

/// What a HID report descriptor says about a device: HID 1.11, section 6.2.2.
struct ReportLayout {
  std::uint16_t usage_page = 0;     ///< of the first application collection; 1: generic desktop
  std::uint16_t usage = 0;          ///< of the same; 5: gamepad
  std::vector<ReportSize> reports;  ///< by kind and id

  /// Size of a report [bytes]; 0: the device has none of this kind and id.
  std::size_t sizeOf(ReportSize::Kind kind, std::uint8_t id) const;
};

constexpr std::size_t kMaxReportDescriptor = 4096;  ///< as in the Linux kernel [bytes]

/// Reads a report descriptor from anywhere: no input makes it crash or run long.
/// @throws Error with the offset of the item that cannot be understood
ReportLayout parseReportDescriptor(const std::uint8_t* bytes, std::size_t size);

/// Which of the two devices is meant.
enum class DeviceKind : std::uint8_t { Haptic, Input };
constexpr int kDeviceKinds = 2;           ///< length of arrays indexed by DeviceKind
const char* deviceName(DeviceKind kind);  ///< "haptic device", "input device"

/// Checks that a device with this descriptor speaks the protocol of vibe_firmware.
/// @throws Error with the first difference and what to do
void checkReportDescriptor(const std::uint8_t* bytes, std::size_t size, DeviceKind kind);

}  // namespace vibe::hardware
