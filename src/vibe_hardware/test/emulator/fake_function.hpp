#pragma once
#include <algorithm>
#include <string>
#include <vector>

#include "vibe_firmware/protocol/control_endpoint.hpp"
#include "vibe_firmware/protocol/descriptors.hpp"

namespace vibe::hardware::test {

/// A HID device for tests: feature report 2 can be set and got, report 3 only got, all others stall.
class FakeFunction final : public vibe_firmware::HidFunction {
 public:
  explicit FakeFunction(std::string serial = "F-1") : serial_(std::move(serial)) {}

  vibe_firmware::Bytes deviceDescriptor() const override { return {device_.data(), device_.size()}; }
  vibe_firmware::Bytes configurationDescriptor() const override {
    return {configuration_.data(), configuration_.size()};
  }
  vibe_firmware::Bytes reportDescriptor() const override {
    return {vibe_firmware::kHapticReportDescriptor.data(), sizeof vibe_firmware::kHapticReportDescriptor};
  }
  vibe_firmware::Bytes string(std::uint8_t index) const override {
    const std::string* text = index == 1 ? &maker_ : index == 2 ? &name_ : index == 3 ? &serial_ : nullptr;
    if (text == nullptr) return {};
    return {reinterpret_cast<const std::uint8_t*>(text->data()), text->size()};
  }

  std::size_t getReport(vibe_firmware::ReportType type, std::uint8_t id, std::uint8_t* bytes,
                        std::size_t capacity) override {
    if (type != vibe_firmware::ReportType::Feature || (id != 2 && id != 3)) return 0;
    const std::vector<std::uint8_t> report = id == 2 ? stored : std::vector<std::uint8_t>{3, 7};
    const std::size_t size = std::min(capacity, report.size());
    std::copy_n(report.begin(), size, bytes);
    return size;
  }

  bool setReport(vibe_firmware::ReportType type, std::uint8_t id, const std::uint8_t* bytes,
                 std::size_t size) override {
    if (type != vibe_firmware::ReportType::Feature || id != 2 || size != 4 || bytes[0] != 2) return false;
    stored.assign(bytes, bytes + size);
    return true;
  }

  std::vector<std::uint8_t> stored{2, 0, 0, 0};

 private:
  std::string maker_ = "maker", name_ = "fake", serial_;
  std::array<std::uint8_t, 18> device_ = vibe_firmware::deviceDescriptor(vibe_firmware::kHapticProductId);
  std::array<std::uint8_t, vibe_firmware::kConfigurationSize> configuration_ =
      vibe_firmware::configurationDescriptor(sizeof vibe_firmware::kHapticReportDescriptor);
};

}  // namespace vibe::hardware::test
