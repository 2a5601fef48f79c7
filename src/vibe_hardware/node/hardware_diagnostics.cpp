#include "hardware_diagnostics.hpp"

#include <cmath>

namespace vibe::hardware {
namespace {

using diagnostic_msgs::DiagnosticStatus;
using diagnostic_updater::DiagnosticStatusWrapper;

constexpr double kLowestRate = 90;  // of 100 Hz

void addLink(const DeviceStatistics& device, DiagnosticStatusWrapper& status) {
  status.add("state", stateName(device.state));
  status.add("path", device.path);
  status.add("product", device.name);
  status.add("serial number", device.serial);
  status.add("firmware version", device.firmware);
  status.addf("rate [Hz]", "%.1f", device.rate);
  status.addf("age of the last sample [ms]", "%.1f", 1e3 * device.age);
  status.addf("clock drift [ppm]", "%.1f", 1e6 * device.drift);
  status.add("connections", device.connections);
  status.add("reconnects", device.connections > 0 ? device.connections - 1 : 0);
  status.add("late ticks", device.late_ticks);
}

void addCounts(const StreamCounts& counts, DiagnosticStatusWrapper& status) {
  status.add("received reports", counts.received);
  status.add("lost reports", counts.lost);
  status.add("duplicated reports", counts.duplicated);
  status.add("reordered reports", counts.reordered);
  status.add("malformed reports", counts.malformed);
  status.add("implausible reports", counts.implausible);
  status.add("restarts of the device", counts.restarts);
}

void addParameters(const HapticStatistics& haptic, std::uint64_t rejected, DiagnosticStatusWrapper& status) {
  status.add("sent parameters", haptic.sent);
  status.add("clamped parameters", haptic.clamped);
  status.add("refused parameters", haptic.refused);
  status.add("last refusal", haptic.last_refusal);
  status.add("parameters that read back differently", haptic.mismatched);
  status.add("reports of the device without valid parameters for 200 ms", haptic.starved);
  status.add("rejected messages on haptic/parameters", rejected);
}

void warnIf(bool condition, const std::string& sentence, DiagnosticStatusWrapper& status) {
  if (condition) status.mergeSummary(DiagnosticStatus::WARN, sentence);
}

void compare(const StreamCounts& now, const StreamCounts& before, DiagnosticStatusWrapper& status) {
  warnIf(now.lost > before.lost, "reports were lost", status);
  warnIf(now.duplicated > before.duplicated, "reports came twice", status);
  warnIf(now.reordered > before.reordered, "reports were reordered", status);
  warnIf(now.malformed > before.malformed, "reports were malformed", status);
  warnIf(now.implausible > before.implausible, "reports were implausible", status);
}

}  // namespace

void fillDiagnostics(const DeviceStatistics& device, const HapticStatistics* haptic, std::uint64_t rejected,
                     DiagnosticMemory& memory, DiagnosticStatusWrapper& status) {
  status.hardware_id = device.serial.empty() ? "none" : device.serial;
  const bool failed = device.state == LinkState::Unusable || device.state == LinkState::Silent;
  if (failed) {
    status.summary(DiagnosticStatus::ERROR, device.problem);
  } else if (device.state == LinkState::Absent) {
    status.summary(DiagnosticStatus::WARN, "absent; waiting for it");
  } else {
    status.summary(DiagnosticStatus::OK, "running");
    warnIf(device.rate < kLowestRate, "the rate is low", status);
    warnIf((device.flags & vibe_firmware::kEncoderFault) != 0, "an encoder has jumped, motors are off", status);
    warnIf((device.flags & vibe_firmware::kDriveFault) != 0, "the power stage has switched the motors off", status);
  }
  compare(device.counts, memory.counts, status);
  memory.counts = device.counts;
  addLink(device, status);
  addCounts(device.counts, status);
  if (haptic == nullptr) return;
  warnIf(haptic->refused > memory.haptic.refused, "parameters were refused", status);
  warnIf(haptic->mismatched > memory.haptic.mismatched, "parameters read back differently", status);
  warnIf(haptic->starved > memory.haptic.starved, "the device has missed parameters", status);
  memory.haptic = *haptic;
  addParameters(*haptic, rejected, status);
}

}  // namespace vibe::hardware
