#include "vibe_hardware/emulator/usb_host.hpp"

#include <stdexcept>

namespace vibe::hardware {
namespace {

using vibe_firmware::UsbSetup;

// USB 2.0, tables 9-2, 9-4 and 9-5; HID 1.11, section 7
constexpr std::uint8_t kToHost = 0x80, kStandardInterface = 0x01, kClassInterface = 0x21;
constexpr std::uint8_t kGetDescriptor = 6, kSetConfiguration = 9, kGetReport = 1, kSetReport = 9;
constexpr std::uint8_t kDevice = 1, kConfiguration = 2, kString = 3, kHid = 0x21, kReportDescriptor = 0x22;
constexpr std::uint16_t kEnglish = 0x0409;
constexpr std::size_t kCapacity = 512;

std::uint16_t word(int high, int low) {
  return static_cast<std::uint16_t>(high << 8 | low);
}

std::uint16_t wordAt(const std::vector<std::uint8_t>& bytes, std::size_t at) {
  return word(bytes[at + 1], bytes[at]);
}

}  // namespace

UsbHost::UsbHost(vibe_firmware::HidFunction& function) : endpoint_(function) {
  const std::vector<std::uint8_t> device = descriptor(kDevice, 0, 0, 18);
  if (device.size() != 18 || device[0] != 18 || device[1] != kDevice)
    throw std::runtime_error("The device has no valid device descriptor.");
  vendor_ = wordAt(device, 8);
  product_ = wordAt(device, 10);
  for (std::size_t i = 0; i < strings_.size(); ++i) strings_[i] = text(device[14 + i]);
  readReportDescriptor();
  const UsbSetup configure{0, kSetConfiguration, 1, 0, 0};
  if (endpoint_.handle(configure, nullptr, nullptr, 0) == vibe_firmware::ControlEndpoint::kStall)
    throw std::runtime_error("The device does not accept its configuration.");
}

std::vector<std::uint8_t> UsbHost::descriptor(std::uint8_t type, std::uint8_t index, std::uint8_t recipient,
                                              std::size_t length) {
  std::vector<std::uint8_t> bytes(kCapacity);
  const UsbSetup setup{static_cast<std::uint8_t>(kToHost | recipient), kGetDescriptor, word(type, index),
                       type == kString ? kEnglish : std::uint16_t{0}, static_cast<std::uint16_t>(length)};
  const int size = endpoint_.handle(setup, nullptr, bytes.data(), bytes.size());
  bytes.resize(size < 0 ? 0 : static_cast<std::size_t>(size));
  return bytes;
}

std::string UsbHost::text(std::uint8_t index) {
  if (index == 0) return "";
  const std::vector<std::uint8_t> bytes = descriptor(kString, index, 0, 255);
  std::string text;
  for (std::size_t i = 2; i + 1 < bytes.size(); i += 2)  // UTF-16; the strings of these devices are ASCII
    text += bytes[i + 1] == 0 && bytes[i] >= 0x20 && bytes[i] < 0x7F ? static_cast<char>(bytes[i]) : '?';
  return text;
}

void UsbHost::readReportDescriptor() {
  const std::vector<std::uint8_t> configuration = descriptor(kConfiguration, 0, 0, kCapacity);
  std::size_t length = 0;
  for (std::size_t at = 0; at + 1 < configuration.size() && configuration[at] >= 2; at += configuration[at])
    if (configuration[at + 1] == kHid && at + 8 < configuration.size()) length = wordAt(configuration, at + 7);
  report_descriptor_ = descriptor(kReportDescriptor, 0, kStandardInterface, length);
  if (length == 0 || report_descriptor_.size() != length)
    throw std::runtime_error("The device has no report descriptor of the length that its HID descriptor states.");
}

std::vector<std::uint8_t> UsbHost::getFeature(std::uint8_t id) {
  std::vector<std::uint8_t> bytes(kCapacity);
  const UsbSetup setup{static_cast<std::uint8_t>(kToHost | kClassInterface), kGetReport,
                       word(static_cast<int>(vibe_firmware::ReportType::Feature), id), 0,
                       static_cast<std::uint16_t>(bytes.size())};
  const int size = endpoint_.handle(setup, nullptr, bytes.data(), bytes.size());
  bytes.resize(size < 0 ? 0 : static_cast<std::size_t>(size));
  return bytes;
}

bool UsbHost::setFeature(const std::uint8_t* bytes, std::size_t size) {
  if (size == 0 || size > kCapacity) return false;
  const UsbSetup setup{kClassInterface, kSetReport,
                       word(static_cast<int>(vibe_firmware::ReportType::Feature), bytes[0]), 0,
                       static_cast<std::uint16_t>(size)};
  return endpoint_.handle(setup, bytes, nullptr, 0) != vibe_firmware::ControlEndpoint::kStall;
}

}  // namespace vibe::hardware
