#pragma once
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "vibe_firmware/protocol/control_endpoint.hpp"
#include "vibe_firmware/protocol/mailbox.hpp"
#include "vibe_firmware/protocol/reports.hpp"
#include "vibe_firmware/version.hpp"

namespace vibe_firmware {

/// @return size of the report; 0: it does not fit
template <std::size_t kSize, typename Report>
std::size_t packInto(const Report& report, std::uint8_t* bytes, std::size_t capacity) {
  if (capacity < kSize) return 0;
  std::uint8_t packed[kSize];
  pack(report, packed);
  std::memcpy(bytes, packed, kSize);
  return kSize;
}

/// A HID device of ViBE: the loop of 1 kHz on one side, the host's reports on the other.
///
/// tick() of the derived class and countLateTick() belong to the interrupt of the loop, everything else to the main
/// loop, and neither masks the other: reports come from the last tick, whole. A program that calls both from several
/// threads needs a lock.
/// @tparam Config  HapticConfig or InputConfig
template <typename Config>
class DeviceFunction : public HidFunction {
 public:
  /// A tick began more than 10 % of the period too late. Interrupt of the loop.
  void countLateTick() { late_ticks_.fetch_add(1, std::memory_order_relaxed); }

  /// The input report, once each Config::report_ticks: to be called in the main loop as often as possible. If it is
  /// called too rarely, reports are left out, and the sequence number shows it.
  /// @return whether there is one that was not returned yet
  bool nextReport(std::uint8_t (&bytes)[kInputReportSize]) {
    InputReport report;
    const std::uint32_t number = report_.read(report);
    if (number == reports_sent_) return false;
    reports_sent_ = number;
    report.flags = static_cast<std::uint8_t>(report.flags | (status_.flags & kRefused));
    pack(report, bytes);
    return true;
  }

  const Config& config() const { return config_; }  ///< as it was given; does not change

  Bytes deviceDescriptor() const override { return descriptors_.device; }
  Bytes configurationDescriptor() const override { return descriptors_.configuration; }
  Bytes reportDescriptor() const override { return descriptors_.report; }
  Bytes string(std::uint8_t index) const override {
    const std::array<const char*, 4> texts{"", "ViBE", descriptors_.product, serial_};  // as the device descriptor says
    if (index == 0 || index >= texts.size()) return {};
    return {reinterpret_cast<const std::uint8_t*>(texts[index]), std::strlen(texts[index])};
  }

  std::size_t getReport(ReportType type, std::uint8_t id, std::uint8_t* bytes, std::size_t capacity) override {
    if (type == ReportType::Input && id == kInputReportId) {
      InputReport report;
      report_.read(report);
      return packInto<kInputReportSize>(report, bytes, capacity);
    }
    if (type != ReportType::Feature) return 0;
    if (id == kStatusReportId) return packInto<kStatusReportSize>(status(), bytes, capacity);
    for (std::uint8_t axis = 0; axis < kAxisCount; ++axis)
      if (id == kAxisReportId + axis)
        return packInto<kAxisReportSize>(AxisReport{axis, config_.axes[axis]}, bytes, capacity);
    return 0;
  }

  /// No report can be set unless a device has one.
  bool setReport(ReportType, std::uint8_t, const std::uint8_t*, std::size_t) override { return false; }

 protected:
  /// What the host asks for.
  struct Descriptors {
    Bytes device, configuration, report;  ///< of USB and HID
    const char* product;                  ///< name of the device
  };
  DeviceFunction(const Config& config, const Descriptors& descriptors, const char* serial)
      : config_(config), descriptors_(descriptors), serial_(serial) {
    status_.version = kFirmwareVersion;
  }
  ~DeviceFunction() = default;

  /// Last in a tick. @param flags  DeviceFlag bits of this tick
  template <typename State>
  void publish(std::uint8_t flags, State& state) {
    flags_.store(flags, std::memory_order_relaxed);
    if (ticks_to_report_ == 0) {
      report_.publish(takeReport(config_, state));
      ticks_to_report_ = config_.report_ticks;
    }
    --ticks_to_report_;
  }

  StatusReport status() const {
    StatusReport status = status_;
    status.flags =
        static_cast<std::uint8_t>((flags_.load(std::memory_order_relaxed) & ~kRefused) | (status_.flags & kRefused));
    status.late_ticks = late_ticks_.load(std::memory_order_relaxed);
    return status;
  }

  const Config config_;
  StatusReport status_{};               ///< of the main loop: version, and verdicts on parameters
  Published<InputReport> report_;       ///< of the last tick with one
  std::atomic<std::uint8_t> flags_{0};  ///< of the last tick

 private:
  const Descriptors descriptors_;
  const char* const serial_;
  std::uint32_t ticks_to_report_ = 0;  // of the interrupt
  std::uint32_t reports_sent_ = 0;     // of the main loop
  std::atomic<std::uint32_t> late_ticks_{0};
};

}  // namespace vibe_firmware
