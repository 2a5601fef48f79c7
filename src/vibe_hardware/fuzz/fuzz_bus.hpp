#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <vector>

#include "fuzz_input.hpp"
#include "vibe_firmware/protocol/descriptors.hpp"
#include "vibe_hardware/hid/hid_port.hpp"

namespace vibe::hardware {

using vibe_firmware::FuzzInput;
using vibe_firmware::require;

/// A haptic device on a bus, both made up by the fuzzer. Reports and answers are often nearly right, so that the driver
/// gets past its first checks.
class FuzzBus : public HidBus {
 public:
  explicit FuzzBus(FuzzInput& input) : input_(input) {}

  double now = 10;
  /// Called with each set of parameters that the driver sends.
  void (*sent)(const vibe_firmware::ParameterReport&, const std::array<vibe_firmware::AxisConfig, 2>&) = nullptr;

  std::vector<HidInfo> list() override {
    if (input_.byte() == 1) throw std::runtime_error("no bus");
    return {{"/fuzz", vibe_firmware::kVendorId, vibe_firmware::kHapticProductId, "", ""}};
  }

  std::unique_ptr<HidPort> open(const std::string&) override {
    const std::uint8_t choice = input_.byte();
    if (choice == 1) throw DeviceGone("gone");
    if (choice == 2) throw std::runtime_error("not permitted");
    return std::make_unique<Port>(*this);
  }

 private:
  class Port : public HidPort {
   public:
    explicit Port(FuzzBus& bus) : bus_(bus) {}

    std::size_t read(std::uint8_t* bytes, std::size_t capacity, double timeout) override {
      FuzzInput& input = bus_.input_;
      const std::uint8_t choice = input.byte();
      bus_.now += timeout;
      if (input.empty() || choice < 64) return 0;
      if (choice == 64) throw DeviceGone("gone");
      bus_.now += 1e-3 * (choice & 15);
      if (choice < 128) {  // any bytes
        const std::size_t size = std::min<std::size_t>(input.byte(), capacity);
        input.fill(bytes, size);
        return size;
      }
      ++report_.sequence;  // the next report, with a few fields changed
      report_.time_us += 10000;
      if (choice & 16) report_.sequence = static_cast<std::uint16_t>(report_.sequence + input.byte() - 128);
      if (choice & 32) report_.time_us += static_cast<std::uint32_t>(input.byte()) << 20;
      report_.flags = input.byte();
      report_.parameter_number = static_cast<std::uint16_t>(number_ - (input.byte() & 15));
      std::uint8_t packed[vibe_firmware::kInputReportSize];
      vibe_firmware::pack(report_, packed);
      std::memcpy(bytes, packed, sizeof packed);
      return sizeof packed;
    }

    std::size_t getFeature(std::uint8_t id, std::uint8_t* bytes, std::size_t capacity) override {
      const std::uint8_t choice = bus_.input_.byte();
      if (choice == 1) throw DeviceGone("gone");
      if (choice == 2) throw ReportRejected("stall");
      if (choice == 3) {
        const std::size_t size = std::min<std::size_t>(bus_.input_.byte(), capacity);
        bus_.input_.fill(bytes, size);
        return size;
      }
      const std::size_t size = answer(id, bytes);
      if (choice > 200 && size > 0) bytes[bus_.input_.byte() % size] = bus_.input_.byte();
      note(bytes, size);
      return size;
    }

    void setFeature(const std::uint8_t* bytes, std::size_t size) override {
      vibe_firmware::ParameterReport report;
      require(vibe_firmware::unpack(bytes, size, report));
      number_ = report.number;
      bus_.sent(report, axes_);
      const std::uint8_t choice = bus_.input_.byte();
      if (choice == 1) throw DeviceGone("gone");
      if (choice == 2) throw ReportRejected("stall");
    }

    std::vector<std::uint8_t> reportDescriptor() override {
      std::vector<std::uint8_t> bytes(std::begin(vibe_firmware::kHapticReportDescriptor),
                                      std::end(vibe_firmware::kHapticReportDescriptor));
      const std::uint8_t choice = bus_.input_.byte();
      if (choice == 1) return {};
      if (choice > 240) bytes[bus_.input_.byte() % bytes.size()] = bus_.input_.byte();
      return bytes;
    }

   private:
    FuzzBus& bus_;
    vibe_firmware::InputReport report_{};
    std::array<vibe_firmware::AxisConfig, 2> axes_{};
    std::uint16_t number_ = 0;

    template <std::size_t Size, class Report>
    static std::size_t put(const Report& report, std::uint8_t* bytes) {
      std::uint8_t packed[Size];
      vibe_firmware::pack(report, packed);
      std::memcpy(bytes, packed, Size);
      return Size;
    }

    std::size_t answer(std::uint8_t id, std::uint8_t* bytes) {
      using namespace vibe_firmware;
      if (id == kStatusReportId) return put<kStatusReportSize>(StatusReport{}, bytes);
      if (id == kParameterReportId) return put<kParameterReportSize>(ParameterReport{}, bytes);
      return put<kAxisReportSize>(AxisReport{static_cast<std::uint8_t>(id - kAxisReportId), {}}, bytes);
    }

    /// The configuration that the driver now believes in.
    void note(const std::uint8_t* bytes, std::size_t size) {
      vibe_firmware::AxisReport report;
      if (vibe_firmware::unpack(bytes, size, report) && report.axis < 2) axes_[report.axis] = report.config;
    }
  };

  FuzzInput& input_;
};

}  // namespace vibe::hardware
