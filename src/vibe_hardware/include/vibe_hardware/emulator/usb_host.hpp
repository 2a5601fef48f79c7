#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "vibe_firmware/protocol/control_endpoint.hpp"

namespace vibe::hardware {

/// What the USB core of a kernel does with a device, for an emulated one: enumerates it and exchanges feature reports,
/// all through the control endpoint of the firmware.
class UsbHost {
 public:
  /// Enumerates the device. @throws std::runtime_error if it stalls on a request that every HID device has to know, or
  /// if its descriptors contradict each other
  explicit UsbHost(vibe_firmware::HidFunction& function);

  std::uint16_t vendor() const { return vendor_; }                 ///< USB id
  std::uint16_t product() const { return product_; }               ///< USB id
  const std::string& manufacturer() const { return strings_[0]; }  ///< string of its device descriptor; empty: none
  const std::string& name() const { return strings_[1]; }          ///< the same, of the product
  const std::string& serial() const { return strings_[2]; }        ///< the same, serial number
  /// As the device sent it; see parseReportDescriptor().
  const std::vector<std::uint8_t>& reportDescriptor() const { return report_descriptor_; }

  /// @return the report with its id; empty: the device stalls
  std::vector<std::uint8_t> getFeature(std::uint8_t id);
  /// @return false: the device stalls
  bool setFeature(const std::uint8_t* bytes, std::size_t size);

 private:
  std::vector<std::uint8_t> descriptor(std::uint8_t type, std::uint8_t index, std::uint8_t recipient,
                                       std::size_t length);
  std::string text(std::uint8_t index);
  void readReportDescriptor();

  vibe_firmware::ControlEndpoint endpoint_;
  std::uint16_t vendor_ = 0, product_ = 0;
  std::array<std::string, 3> strings_;
  std::vector<std::uint8_t> report_descriptor_;
};

}  // namespace vibe::hardware
