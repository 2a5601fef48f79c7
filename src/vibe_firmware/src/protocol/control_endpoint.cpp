#include "vibe_firmware/protocol/control_endpoint.hpp"

#include <cstring>

namespace vibe_firmware {
namespace {

// request types: direction, kind, recipient (USB 2.0, table 9-2)
constexpr std::uint8_t kToHost = 0x80, kClass = 0x20, kInterface = 0x01, kEndpoint = 0x02;
// standard requests (USB 2.0, table 9-4)
constexpr std::uint8_t kGetStatus = 0, kClearFeature = 1, kSetFeature = 3, kSetAddress = 5, kGetDescriptor = 6,
                       kGetConfiguration = 8, kSetConfiguration = 9, kGetInterface = 10, kSetInterface = 11;
// descriptor types (USB 2.0, table 9-5; HID 1.11, section 7.1)
constexpr std::uint8_t kDeviceType = 1, kConfigurationType = 2, kStringType = 3, kHidType = 0x21, kReportType = 0x22;
// requests of the HID class (HID 1.11, section 7.2)
constexpr std::uint8_t kGetReport = 1, kGetIdle = 2, kSetReport = 9, kSetIdle = 10;

constexpr std::uint16_t kInterruptEndpoint = 0x81, kEndpointHalt = 0;
constexpr std::size_t kHidDescriptorOffset = 18, kHidDescriptorSize = 9;  // in the configuration descriptor
constexpr std::size_t kLongestReport = 64, kLongestString = 126;          // one packet; length byte of a descriptor

std::uint8_t highByte(std::uint16_t value) {
  return static_cast<std::uint8_t>(value >> 8);
}
std::uint8_t lowByte(std::uint16_t value) {
  return static_cast<std::uint8_t>(value & 0xFF);
}

/// As much of the answer as the host has asked for.
int respond(Bytes answer, const UsbSetup& setup, std::uint8_t* response, std::size_t capacity) {
  std::size_t size = answer.size < setup.length ? answer.size : setup.length;
  if (size > capacity) size = capacity;
  if (size > 0) std::memcpy(response, answer.data, size);
  return static_cast<int>(size);
}

int respondByte(std::uint8_t value, const UsbSetup& setup, std::uint8_t* response, std::size_t capacity) {
  return respond({&value, 1}, setup, response, capacity);
}

int respondStatus(std::uint8_t status, const UsbSetup& setup, std::uint8_t* response, std::size_t capacity) {
  const std::uint8_t bytes[2] = {status, 0};
  return respond({bytes, 2}, setup, response, capacity);
}

}  // namespace

int ControlEndpoint::handle(const UsbSetup& setup, const std::uint8_t* data, std::uint8_t* response,
                            std::size_t capacity) {
  switch (setup.request_type & ~kToHost) {
    case 0:
      return standardDevice(setup, response, capacity);
    case kInterface:
      return setup.index == 0 ? standardInterface(setup, response, capacity) : kStall;
    case kEndpoint:
      return standardEndpoint(setup, response, capacity);
    case kClass | kInterface:
      return setup.index == 0 ? classInterface(setup, data, response, capacity) : kStall;
    default:
      return kStall;
  }
}

void ControlEndpoint::reset() {
  configuration_ = 0;
  idle_rate_ = 0;
  halted_ = false;
}

int ControlEndpoint::standardDevice(const UsbSetup& setup, std::uint8_t* response, std::size_t capacity) {
  switch (setup.request_type << 8 | setup.request) {
    case kToHost << 8 | kGetStatus:
      return respondStatus(0, setup, response, capacity);  // bus-powered, no remote wakeup
    case kToHost << 8 | kGetDescriptor:
      return descriptor(setup, response, capacity);
    case kToHost << 8 | kGetConfiguration:
      return respondByte(configuration_, setup, response, capacity);
    case kSetAddress:
      return setup.value <= 127 ? 0 : kStall;
    case kSetConfiguration:
      if (setup.value > 1) return kStall;
      configuration_ = lowByte(setup.value);
      halted_ = false;
      return 0;
    default:
      return kStall;
  }
}

int ControlEndpoint::standardInterface(const UsbSetup& setup, std::uint8_t* response, std::size_t capacity) {
  const int request = setup.request_type << 8 | setup.request;
  if (request == ((kToHost | kInterface) << 8 | kGetDescriptor)) return descriptor(setup, response, capacity);
  if (!configured()) return kStall;
  switch (request) {
    case (kToHost | kInterface) << 8 | kGetStatus:
      return respondStatus(0, setup, response, capacity);
    case (kToHost | kInterface) << 8 | kGetInterface:
      return respondByte(0, setup, response, capacity);
    case kInterface << 8 | kSetInterface:
      if (setup.value != 0) return kStall;
      halted_ = false;  // as with a new configuration (USB 2.0, 9.4.5)
      return 0;
    default:
      return kStall;
  }
}

int ControlEndpoint::standardEndpoint(const UsbSetup& setup, std::uint8_t* response, std::size_t capacity) {
  const bool control = (setup.index & 0x7F) == 0;
  if (!control && (setup.index != kInterruptEndpoint || !configured())) return kStall;
  switch (setup.request_type << 8 | setup.request) {
    case (kToHost | kEndpoint) << 8 | kGetStatus:
      return respondStatus(!control && halted_ ? 1 : 0, setup, response, capacity);
    case kEndpoint << 8 | kClearFeature:
    case kEndpoint << 8 | kSetFeature:
      if (control || setup.value != kEndpointHalt) return kStall;
      halted_ = setup.request == kSetFeature;
      return 0;
    default:
      return kStall;
  }
}

int ControlEndpoint::classInterface(const UsbSetup& setup, const std::uint8_t* data, std::uint8_t* response,
                                    std::size_t capacity) {
  const auto type = static_cast<ReportType>(highByte(setup.value));
  switch (setup.request_type << 8 | setup.request) {
    case (kToHost | kClass | kInterface) << 8 | kGetReport: {
      std::uint8_t report[kLongestReport];
      const std::size_t size = function_.getReport(type, lowByte(setup.value), report, sizeof report);
      return size == 0 ? kStall : respond({report, size}, setup, response, capacity);
    }
    case (kToHost | kClass | kInterface) << 8 | kGetIdle:
      return respondByte(idle_rate_, setup, response, capacity);
    case (kClass | kInterface) << 8 | kSetReport:
      return function_.setReport(type, lowByte(setup.value), data, setup.length) ? 0 : kStall;
    case (kClass | kInterface) << 8 | kSetIdle:
      idle_rate_ = highByte(setup.value);
      return 0;
    default:
      return kStall;
  }
}

int ControlEndpoint::descriptor(const UsbSetup& setup, std::uint8_t* response, std::size_t capacity) const {
  const bool of_interface = (setup.request_type & kInterface) != 0;
  const Bytes configuration = function_.configurationDescriptor();
  switch (highByte(setup.value)) {
    case kDeviceType:
      return of_interface ? kStall : respond(function_.deviceDescriptor(), setup, response, capacity);
    case kConfigurationType:
      if (of_interface || lowByte(setup.value) != 0) return kStall;
      return respond(configuration, setup, response, capacity);
    case kStringType:
      return of_interface ? kStall : string(setup, response, capacity);
    case kHidType:
      if (!of_interface || configuration.size < kHidDescriptorOffset + kHidDescriptorSize) return kStall;
      return respond({configuration.data + kHidDescriptorOffset, kHidDescriptorSize}, setup, response, capacity);
    case kReportType:
      return of_interface ? respond(function_.reportDescriptor(), setup, response, capacity) : kStall;
    default:
      return kStall;
  }
}

int ControlEndpoint::string(const UsbSetup& setup, std::uint8_t* response, std::size_t capacity) const {
  std::uint8_t bytes[2 + 2 * kLongestString] = {4, kStringType, 0x09, 0x04};  // index 0: English (United States) only
  const std::uint8_t index = lowByte(setup.value);
  if (index > 0) {
    const Bytes text = function_.string(index);
    if (text.size == 0 || text.size > kLongestString) return kStall;
    bytes[0] = static_cast<std::uint8_t>(2 + 2 * text.size);
    for (std::size_t i = 0; i < text.size; ++i) {  // ASCII to UTF-16
      bytes[2 + 2 * i] = text.data[i];
      bytes[3 + 2 * i] = 0;
    }
  }
  return respond({bytes, bytes[0]}, setup, response, capacity);
}

}  // namespace vibe_firmware
