#include "firmware_device.hpp"

#include <sys/timerfd.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>

#include "scripted_hand.hpp"
#include "vibe_firmware/protocol/descriptors.hpp"

namespace vibe {
namespace {

constexpr long kPeriod = 1'000'000;             // of the loop [ns]
constexpr std::uint32_t kTicksPerReport = 10;

/// Descriptor of a timer that expires with the period of the loop.
int periodicTimer() {
  const int timer = timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC);
  const itimerspec period{{0, kPeriod}, {0, kPeriod}};
  if (timer < 0 || timerfd_settime(timer, 0, &period, nullptr) != 0) {
    throw std::runtime_error(std::string("no timer: ") + std::strerror(errno));
  }
  return timer;
}

/// TEMPORARY until the firmware has it
class TemporaryFunction : public vibe_firmware::HidFunction {
 public:
  TemporaryFunction(std::uint16_t product, vibe_firmware::Bytes report)
      : device_(vibe_firmware::deviceDescriptor(product)),
        configuration_(vibe_firmware::configurationDescriptor(report.size)),
        report_(report) {}
  vibe_firmware::Bytes deviceDescriptor() const override { return {device_.data(), device_.size()}; }
  vibe_firmware::Bytes configurationDescriptor() const override {
    return {configuration_.data(), configuration_.size()};
  }
  vibe_firmware::Bytes reportDescriptor() const override { return report_; }
  vibe_firmware::Bytes string(std::uint8_t index) const override {
    static const char* const strings[] = {"", "ViBE", "test device", "0001"};
    if (index > 3) return {};
    return {reinterpret_cast<const std::uint8_t*>(strings[index]), std::strlen(strings[index])};
  }
  std::size_t getReport(vibe_firmware::ReportType, std::uint8_t id, std::uint8_t* bytes, std::size_t capacity) override {
    if (id == 2 && capacity >= sizeof parameters_) {
      pack(parameters_report_, parameters_);
      std::memcpy(bytes, parameters_, sizeof parameters_);
      return sizeof parameters_;
    }
    if (id == 3) {
      std::uint8_t b[vibe_firmware::kStatusReportSize];
      const auto n = pack(vibe_firmware::StatusReport{}, b);
      std::memcpy(bytes, b, n);
      return n;
    }
    return 0;
  }
  bool setReport(vibe_firmware::ReportType, std::uint8_t id, const std::uint8_t* bytes, std::size_t size) override {
    return id == 2 && unpack(bytes, size, parameters_report_);
  }
  void tick(const vibe_firmware::HapticSample& sample) { sample_ = sample; }
  vibe_firmware::InputReport takeReport() {
    vibe_firmware::InputReport report;
    report.sequence = sequence_++;
    report.time_us = sample_.time_us;
    report.buttons = sample_.buttons;
    for (int a = 0; a < 2; ++a) {report.axes[a] = static_cast<std::int16_t>(sample_.counter[a]); report.counts[a] = report.axes[a]; }
    return report;
  }

 private:
  std::array<std::uint8_t, 18> device_;
  std::array<std::uint8_t, 34> configuration_;
  vibe_firmware::Bytes report_;
  vibe_firmware::HapticSample sample_;
  std::uint16_t sequence_ = 0;
  vibe_firmware::ParameterReport parameters_report_;
  std::uint8_t parameters_[vibe_firmware::kParameterReportSize];
};

class FirmwareDevice : public UsbDevice {
 public:
  FirmwareDevice(std::uint16_t product, vibe_firmware::Bytes report) : function_(product, report) {}
  ~FirmwareDevice() override { close(timer_); }

  int control(const vibe_firmware::UsbSetup& setup, const std::uint8_t* data, std::uint8_t* response,
              std::size_t capacity) override {
    return control_.handle(setup, data, response, capacity);
  }

  int descriptor() const override { return timer_; }

  void service(const ReportSink& sink) override {
    std::uint64_t due = 0;  // ticks; more than one if this process had to wait
    if (read(timer_, &due, sizeof due) != sizeof due) return;
    for (; due > 0; --due) {
      function_.tick(scriptedHand(tick_++));
      if (tick_ % kTicksPerReport == 0) {
        std::uint8_t bytes[vibe_firmware::kInputReportSize];
        const std::size_t size = pack(function_.takeReport(), bytes);
        sink(bytes, size);
      }
    }
  }

 private:
  TemporaryFunction function_;
  vibe_firmware::ControlEndpoint control_{function_};
  int timer_ = periodicTimer();
  std::uint32_t tick_ = 0;
};

}  // namespace

std::unique_ptr<UsbDevice> makeHapticDevice() {
  return std::make_unique<FirmwareDevice>(
      vibe_firmware::kHapticProductId,
      vibe_firmware::Bytes{vibe_firmware::kHapticReportDescriptor, sizeof vibe_firmware::kHapticReportDescriptor});
}

std::unique_ptr<UsbDevice> makeInputDevice() {
  return std::make_unique<FirmwareDevice>(
      vibe_firmware::kInputProductId,
      vibe_firmware::Bytes{vibe_firmware::kInputReportDescriptor, sizeof vibe_firmware::kInputReportDescriptor});
}

}  // namespace vibe
