#pragma once
#include <array>
#include <cstdint>

#include "vibe_firmware/protocol/reports.hpp"

// USB descriptors of both devices, the only place where they are written down: firmware, emulator and host use this
// header. USB 2.0, chapter 9; HID 1.11, chapters 6 and 7.

namespace vibe_firmware {

/// pid.codes' ids for private tests. A device that is shipped needs ids of its own.
constexpr std::uint16_t kVendorId = 0x1209;
constexpr std::uint16_t kHapticProductId = 0x0001;  ///< of the haptic device
constexpr std::uint16_t kInputProductId = 0x0002;   ///< of the input device

namespace descriptor_detail {
/// Byte of a little-endian number, which comes first.
constexpr std::uint8_t low(std::size_t value) {
  return static_cast<std::uint8_t>(value & 0xFF);
}
/// Byte of a number below 65536, which comes second.
constexpr std::uint8_t high(std::size_t value) {
  return static_cast<std::uint8_t>(value >> 8);
}
constexpr std::size_t kGamepadBytes = 6;  ///< two axes and sixteen buttons

/// Up to the end of the input report, of both devices.
constexpr std::uint8_t kGamepad[] = {
    0x05, 0x01,           0x09, 0x05,
    0xA1, 0x01,            // usage page: generic desktop; usage: game pad; collection: application
    0x85, kInputReportId,  //   report id
    0x09, 0x30,           0x09, 0x31,
    0x16, 0x01,           0x80, 0x26,
    0xFF, 0x7F,  //   usages: X, Y; logical -32767 to 32767
    0x75, 0x10,           0x95, 0x02,
    0x81, 0x02,  //   2 x 16 bit, input, variable
    0x05, 0x09,           0x19, 0x01,
    0x29, 0x10,                        //   usage page: buttons 1 to 16
    0x15, 0x00,           0x25, 0x01,  //   logical 0 to 1
    0x75, 0x01,           0x95, 0x10,
    0x81, 0x02,  //   16 x 1 bit, input, variable
    0x06, 0x00,           0xFF, 0x15,
    0x00, 0x26,           0xFF, 0x00,
    0x75, 0x08,  //   vendor page, bytes
    0x09, 0x01,           0x95, kInputReportSize - 1 - kGamepadBytes,
    0x81, 0x02,  //   rest of the input report
};
/// The feature report with which the host sets a device.
constexpr std::uint8_t kParameters[] = {
    0x85, kParameterReportId, 0x09, 0x02, 0x95, kParameterReportSize - 1, 0xB1, 0x02,  //   feature: parameters
};
/// The feature reports that the host only reads, and the end.
constexpr std::uint8_t kOtherFeatures[] = {
    0x85, kStatusReportId,   0x09, 0x03, 0x95, kStatusReportSize - 1, 0xB1, 0x02,  //   feature: status
    0x85, kAxisReportId,     0x09, 0x04, 0x95, kAxisReportSize - 1,   0xB1, 0x02,  //   feature: axis 0
    0x85, kAxisReportId + 1, 0x09, 0x05, 0x95, kAxisReportSize - 1,   0xB1, 0x02,  //   feature: axis 1
    0xC0,                                                                          // end of the collection
};

/// Parts of a descriptor in a row.
template <std::size_t... kSizes>
constexpr std::array<std::uint8_t, (kSizes + ...)> joined(const std::uint8_t (&... parts)[kSizes]) {
  std::array<std::uint8_t, (kSizes + ...)> all{};
  std::size_t place = 0;
  const auto append = [&](const auto& part) {
    for (const std::uint8_t byte : part) all[place++] = byte;
  };
  (append(parts), ...);
  return all;
}
}  // namespace descriptor_detail

/// A gamepad with two 16-bit axes and 16 buttons. The rest of the input report and the feature reports are
/// vendor-defined bytes, which gamepad drivers ignore.
constexpr auto kHapticReportDescriptor = descriptor_detail::joined(
    descriptor_detail::kGamepad, descriptor_detail::kParameters, descriptor_detail::kOtherFeatures);

/// The same without parameters: the input device has no motors.
constexpr auto kInputReportDescriptor =
    descriptor_detail::joined(descriptor_detail::kGamepad, descriptor_detail::kOtherFeatures);

/// Device descriptor: full speed, class in the interface, strings 1 to 3.
constexpr std::array<std::uint8_t, 18> deviceDescriptor(std::uint16_t product) {
  using descriptor_detail::high;
  using descriptor_detail::low;
  return {18,   1,    0x00, 0x02, 0, 0, 0, 64, low(kVendorId), high(kVendorId), low(product), high(product),
          0x00, 0x01, 1,    2,    3, 1};
}

/// Configuration with one HID interface and one interrupt endpoint (0x81, 64 bytes, polled every 4 ms: the
/// firmware sets the rate and answers NAK in between).
constexpr std::size_t kConfigurationSize = 9 + 9 + 9 + 7;
/// The same as bytes. @param report_descriptor_size  [bytes], at most 65535
constexpr std::array<std::uint8_t, kConfigurationSize> configurationDescriptor(std::size_t report_descriptor_size) {
  using descriptor_detail::high;
  using descriptor_detail::low;
  // bus-powered, 100 mA: the motors have a supply of their own
  const std::uint8_t configuration[] = {9, 2, kConfigurationSize, 0, 1, 1, 0, 0x80, 50};
  const std::uint8_t interface[] = {9, 4, 0, 0, 1, 3, 0, 0, 0};  // interface 0, HID, no boot protocol
  const std::uint8_t hid[] = {
      9, 0x21, 0x11, 0x01, 0, 1, 0x22, low(report_descriptor_size), high(report_descriptor_size)};
  const std::uint8_t endpoint[] = {7, 5, 0x81, 3, 64, 0, 4};
  return descriptor_detail::joined(configuration, interface, hid, endpoint);
}

static_assert(kInputReportSize <= 64 && kParameterReportSize <= 64, "one packet per report");

}  // namespace vibe_firmware
