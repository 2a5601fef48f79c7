#include "vibe_firmware/core/haptic_device.hpp"

#include "core/sample_report.hpp"
#include "vibe_firmware/core/passivity.hpp"
#include "vibe_firmware/version.hpp"

namespace vibe_firmware {
namespace {

bool anyFault(const HapticState& state) {
  bool fault = false;
  for (const AxisState& axis : state.axes) fault = fault || axis.encoder.fault;
  return fault;
}

std::uint8_t flagsOf(const HapticConfig& config, bool drive_fault, const HapticState& state) {
  int flags = state.status.flags & kRefused;
  if (drive_fault) flags |= kDriveFault;
  if (config.watchdog().silent(state.ticks_since_host)) flags |= kHostSilent;
  for (std::size_t i = 0; i < kAxisCount; ++i) {
    const AxisState& axis = state.axes[i];
    if (axis.limited) flags |= kLimited;
    if (axis.passivity_acts) flags |= kPassivityActs;
    flags |= encoderFlags(axis.encoder, i);
  }
  return static_cast<std::uint8_t>(flags);
}

}  // namespace

HapticState initialState(const HapticConfig& config) {
  HapticState state;
  for (std::size_t i = 0; i < kAxisCount; ++i) state.axes[i] = initialAxisState(config.axes[i]);
  state.ticks_since_host = config.watchdog().end();
  state.status.version = kFirmwareVersion;
  state.status.flags = flagsOf(config, false, state);
  return state;
}

std::array<float, kAxisCount> step(const HapticConfig& config, const HapticSample& sample, HapticState& state) {
  const Watchdog watchdog = config.watchdog();
  // after a fault of the power stage the spring comes back as after silence: with the next parameters, at the slew
  // limit
  state.ticks_since_host = sample.drive_fault ? watchdog.end() : watchdog.next(state.ticks_since_host);
  const float gain = watchdog.springGain(state.ticks_since_host);
  std::array<float, kAxisCount> torque{};
  for (std::size_t i = 0; i < kAxisCount; ++i)
    torque[i] =
        step(config.axes[i], state.parameters.axes[i], gain, config.counter_bits, sample.encoder(i), state.axes[i]);
  if (sample.drive_fault || anyFault(state)) {
    for (AxisState& axis : state.axes) switchOff(axis);
    torque = {};
  }
  step(config.debounce_ticks, sample.buttons, state.buttons);
  state.time_us = sample.time_us;
  state.status.flags = flagsOf(config, sample.drive_fault, state);
  return torque;
}

Verdict judge(const HapticConfig& config, const ParameterReport& parameters, StatusReport& status) {
  const Verdict verdict = validate(config.axes, parameters.axes);
  if (verdict.refusal == Refusal::None) {
    ++status.accepted;
    status.parameter_number = parameters.number;
    status.flags = static_cast<std::uint8_t>(status.flags & ~kRefused);
  } else {
    ++status.refused;
    status.refused_number = parameters.number;
    status.refusal = verdict;
    status.flags = static_cast<std::uint8_t>(status.flags | kRefused);
  }
  return verdict;
}

void takeOver(const ParameterReport& parameters, HapticState& state) {
  for (std::size_t i = 0; i < kAxisCount; ++i) takeOver(state.parameters.axes[i], parameters.axes[i], state.axes[i]);
  state.parameters = parameters;
  state.ticks_since_host = 0;
}

Verdict setParameters(const HapticConfig& config, const ParameterReport& parameters, HapticState& state) {
  const Verdict verdict = judge(config, parameters, state.status);
  if (verdict.refusal == Refusal::None) takeOver(parameters, state);
  return verdict;
}

InputReport takeReport(const HapticConfig& config, HapticState& state) {
  InputReport report;
  for (std::size_t i = 0; i < kAxisCount; ++i) {
    reportEncoder(config.axes[i], state.axes[i].encoder, i, report);
    report.torque[i] = toInt16(state.axes[i].torque, kTorqueUnit);
  }
  report.buttons = state.buttons.buttons;
  report.sequence = state.sequence++;
  report.time_us = state.time_us;
  report.flags = state.status.flags;
  report.parameter_number = state.parameters.number;
  return report;
}

}  // namespace vibe_firmware
