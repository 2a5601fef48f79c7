#include "vibe_firmware/protocol/haptic_function.hpp"

#include <algorithm>

#include "protocol/function_parts.hpp"
#include "vibe_firmware/protocol/descriptors.hpp"

namespace vibe_firmware {
namespace {

constexpr auto kHapticDevice = deviceDescriptor(kHapticProductId);
constexpr auto kHapticConfiguration = vibe_firmware::configurationDescriptor(sizeof kHapticReportDescriptor);

}  // namespace

HapticFunction::HapticFunction(const HapticConfig& config, const char* serial)
    : config_(config), serial_(serial), state_(initialState(config)), status_(state_.status) {
  flags_.store(state_.status.flags, std::memory_order_relaxed);
}

std::array<float, kAxisCount> HapticFunction::tick(const HapticSample& sample) {
  ParameterReport parameters;
  if (parameters_.take(parameters)) takeOver(parameters, state_);
  if (host_gone_.exchange(false, std::memory_order_relaxed))
    state_.ticks_since_host = std::max(state_.ticks_since_host, config_.host_timeout_ticks);
  const std::array<float, kAxisCount> torque = step(config_, sample, state_);
  flags_.store(state_.status.flags, std::memory_order_relaxed);
  if (ticks_to_report_ == 0) {
    report_.publish(takeReport(config_, state_));
    ticks_to_report_ = config_.report_ticks;
  }
  --ticks_to_report_;
  return torque;
}

bool HapticFunction::nextReport(std::uint8_t (&bytes)[kInputReportSize]) {
  InputReport report;
  const std::uint32_t number = report_.read(report);
  if (number == reports_sent_) return false;
  reports_sent_ = number;
  report.flags = static_cast<std::uint8_t>(report.flags | (status_.flags & kRefused));
  pack(report, bytes);
  return true;
}

StatusReport HapticFunction::status() const {
  StatusReport status = status_;
  status.flags =
      static_cast<std::uint8_t>((flags_.load(std::memory_order_relaxed) & ~kRefused) | (status_.flags & kRefused));
  status.late_ticks = late_ticks_.load(std::memory_order_relaxed);
  return status;
}

Bytes HapticFunction::deviceDescriptor() const {
  return {kHapticDevice.data(), kHapticDevice.size()};
}
Bytes HapticFunction::configurationDescriptor() const {
  return {kHapticConfiguration.data(), kHapticConfiguration.size()};
}
Bytes HapticFunction::reportDescriptor() const {
  return {kHapticReportDescriptor, sizeof kHapticReportDescriptor};
}
Bytes HapticFunction::string(std::uint8_t index) const {
  return deviceString(index, "ViBE haptic device", serial_);
}

std::size_t HapticFunction::getReport(ReportType type, std::uint8_t id, std::uint8_t* bytes, std::size_t capacity) {
  if (type == ReportType::Input && id == kInputReportId) {
    InputReport report;
    report_.read(report);
    report.flags = status().flags;
    return packInto<kInputReportSize>(report, bytes, capacity);
  }
  if (type != ReportType::Feature) return 0;
  if (id == kParameterReportId) return packInto<kParameterReportSize>(accepted_, bytes, capacity);
  if (id == kStatusReportId) return packInto<kStatusReportSize>(status(), bytes, capacity);
  for (std::uint8_t axis = 0; axis < kAxisCount; ++axis)
    if (id == kAxisReportId + axis)
      return packInto<kAxisReportSize>(AxisReport{axis, config_.axes[axis]}, bytes, capacity);
  return 0;
}

bool HapticFunction::setReport(ReportType type, std::uint8_t id, const std::uint8_t* bytes, std::size_t size) {
  ParameterReport parameters;
  if (type != ReportType::Feature || id != kParameterReportId || !unpack(bytes, size, parameters)) return false;
  if (judge(config_, parameters, status_).refusal == Refusal::None) {
    accepted_ = parameters;
    parameters_.put(parameters);
  }
  return true;
}

}  // namespace vibe_firmware
