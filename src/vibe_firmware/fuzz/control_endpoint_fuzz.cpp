#include <cmath>

#include "fuzz_input.hpp"
#include "vibe_firmware/protocol/control_endpoint.hpp"
#include "vibe_firmware/protocol/haptic_function.hpp"
#include "vibe_firmware/protocol/input_function.hpp"

// Any setup packets, parameters, encoder counts and buttons, in any order: no answer is longer than asked for, no motor
// gets more than its limit.

namespace {

using namespace vibe_firmware;

UsbSetup anySetup(FuzzInput& input) {
  UsbSetup setup;
  setup.request_type = input.byte();
  setup.request = input.byte();
  setup.value = input.word();
  setup.index = input.word();
  setup.length = static_cast<std::uint16_t>(input.word() & 0x3FF);
  return setup;
}

/// A report of the HID class, got or set; chance alone rarely makes one.
UsbSetup reportSetup(FuzzInput& input) {
  const bool get = (input.byte() & 1) != 0;
  UsbSetup setup;
  setup.request_type = get ? 0xA1 : 0x21;
  setup.request = get ? 1 : 9;
  setup.value = static_cast<std::uint16_t>((input.byte() & 3) << 8 | (input.byte() & 7));
  setup.length = input.byte() & 63;
  return setup;
}

void request(FuzzInput& input, const UsbSetup& setup, ControlEndpoint& endpoint) {
  const bool to_host = (setup.request_type & 0x80) != 0;
  const std::vector<std::uint8_t> data = input.bytes(to_host ? 0 : setup.length);
  std::vector<std::uint8_t> response(input.word() & 0x1FF);
  const int size = endpoint.handle(setup, data.data(), response.data(), response.size());
  if (size == ControlEndpoint::kStall) return;
  require(size >= 0 && size <= setup.length && static_cast<std::size_t>(size) <= response.size());
}

/// Parameters that may well be accepted.
void setParameters(FuzzInput& input, HapticFunction& function) {
  ParameterReport report;
  report.number = input.word();
  for (AxisParameters& p : report.axes) {
    p.stiffness = static_cast<float>(input.byte()) * 0.01F;
    p.damping = static_cast<float>(input.byte()) * 1e-4F;
    p.position = static_cast<float>(input.word()) * 1e-3F;
    p.torque = static_cast<float>(input.byte()) * 1e-4F;
    p.torque_limit = 0.02F;
  }
  std::uint8_t bytes[kParameterReportSize];
  pack(report, bytes);
  require(function.setReport(ReportType::Feature, kParameterReportId, bytes, sizeof bytes));
}

void tick(FuzzInput& input, HapticFunction& haptic, InputFunction& plain) {
  HapticSample sample;
  for (std::size_t i = 0; i < kAxisCount; ++i) {
    sample.counter[i] = input.word();
    sample.index_counter[i] = input.word();
    sample.index[i] = (input.byte() & 1) != 0;
  }
  sample.buttons = input.word();
  const std::array<float, kAxisCount> torque = haptic.tick(sample);
  plain.tick(sample);
  for (std::size_t i = 0; i < kAxisCount; ++i) {
    require(std::fabs(torque[i]) <= haptic.config().axes[i].torque_limit);
    require(haptic.state().axes[i].energy.balance >= 0);
  }
  std::uint8_t bytes[kInputReportSize];
  if (haptic.nextReport(bytes)) require(bytes[0] == kInputReportId);
  if (plain.nextReport(bytes)) require(bytes[0] == kInputReportId);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  FuzzInput input(data, size);
  HapticFunction haptic{HapticConfig{}};
  InputFunction plain{InputConfig{}};
  ControlEndpoint haptic_endpoint(haptic), plain_endpoint(plain);
  while (!input.empty()) {
    ControlEndpoint& endpoint = (input.byte() & 1) != 0 ? haptic_endpoint : plain_endpoint;
    switch (input.byte() & 3) {
      case 0:
        request(input, anySetup(input), endpoint);
        break;
      case 1:
        request(input, reportSetup(input), endpoint);
        break;
      case 2:
        setParameters(input, haptic);
        break;
      default:
        tick(input, haptic, plain);
    }
  }
  return 0;
}
