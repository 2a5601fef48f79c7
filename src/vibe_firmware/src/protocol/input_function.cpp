#include "vibe_firmware/protocol/input_function.hpp"

#include "protocol/function_parts.hpp"
#include "vibe_firmware/protocol/descriptors.hpp"
#include "vibe_firmware/version.hpp"

namespace vibe_firmware {
namespace {

constexpr auto kInputDevice = deviceDescriptor(kInputProductId);
constexpr auto kInputConfiguration = vibe_firmware::configurationDescriptor(sizeof kInputReportDescriptor);

}  // namespace

InputFunction::InputFunction(const InputConfig& config, const char* serial) : config_(config), serial_(serial) {}

void InputFunction::tick(const HapticSample& sample) {
  step(config_, sample, state_);
  flags_.store(state_.flags, std::memory_order_relaxed);
  if (ticks_to_report_ == 0) {
    report_.publish(takeReport(config_, state_));
    ticks_to_report_ = config_.report_ticks;
  }
  --ticks_to_report_;
}

bool InputFunction::nextReport(std::uint8_t (&bytes)[kInputReportSize]) {
  InputReport report;
  const std::uint32_t number = report_.read(report);
  if (number == reports_sent_) return false;
  reports_sent_ = number;
  pack(report, bytes);
  return true;
}

StatusReport InputFunction::status() const {
  StatusReport status;
  status.version = kFirmwareVersion;
  status.flags = flags_.load(std::memory_order_relaxed);
  status.late_ticks = late_ticks_.load(std::memory_order_relaxed);
  return status;
}

Bytes InputFunction::deviceDescriptor() const {
  return {kInputDevice.data(), kInputDevice.size()};
}
Bytes InputFunction::configurationDescriptor() const {
  return {kInputConfiguration.data(), kInputConfiguration.size()};
}
Bytes InputFunction::reportDescriptor() const {
  return {kInputReportDescriptor, sizeof kInputReportDescriptor};
}
Bytes InputFunction::string(std::uint8_t index) const {
  return deviceString(index, "ViBE input device", serial_);
}

std::size_t InputFunction::getReport(ReportType type, std::uint8_t id, std::uint8_t* bytes, std::size_t capacity) {
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

bool InputFunction::setReport(ReportType, std::uint8_t, const std::uint8_t*, std::size_t) {
  return false;
}

}  // namespace vibe_firmware
