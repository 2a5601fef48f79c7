#include "vibe_firmware/protocol/haptic_function.hpp"

#include <algorithm>

#include "vibe_firmware/protocol/descriptors.hpp"

namespace vibe_firmware {
namespace {

constexpr auto kHapticDevice = deviceDescriptor(kHapticProductId);
constexpr auto kHapticConfiguration = configurationDescriptor(sizeof kHapticReportDescriptor);

}  // namespace

HapticFunction::HapticFunction(const HapticConfig& config, const char* serial)
    : DeviceFunction(config,
                     {bytesOf(kHapticDevice), bytesOf(kHapticConfiguration), bytesOf(kHapticReportDescriptor),
                      "ViBE haptic device"},
                     serial),
      state_(initialState(config)) {
  status_ = state_.status;
  flags_.store(state_.status.flags, std::memory_order_relaxed);
}

std::array<float, kAxisCount> HapticFunction::tick(const HapticSample& sample) {
  ParameterReport parameters;
  if (parameters_.take(parameters)) takeOver(parameters, state_);
  if (host_gone_.exchange(false, std::memory_order_relaxed))
    state_.ticks_since_host = std::max(state_.ticks_since_host, config_.host_timeout_ticks);
  const std::array<float, kAxisCount> torque = step(config_, sample, state_);
  publish(state_.status.flags, state_);
  return torque;
}

std::size_t HapticFunction::getReport(ReportType type, std::uint8_t id, std::uint8_t* bytes, std::size_t capacity) {
  if (type == ReportType::Input && id == kInputReportId) {
    InputReport report;
    report_.read(report);
    report.flags = status().flags;
    return packInto<kInputReportSize>(report, bytes, capacity);
  }
  if (type == ReportType::Feature && id == kParameterReportId)
    return packInto<kParameterReportSize>(accepted_, bytes, capacity);
  return DeviceFunction::getReport(type, id, bytes, capacity);
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
