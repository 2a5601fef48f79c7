#include <cmath>
#include <cstring>

#include "fuzz_input.hpp"
#include "vibe_firmware/core/passivity.hpp"
#include "vibe_firmware/protocol/reports.hpp"

// Any bytes as each of the reports: what is taken packs to the same bytes again, and parameters that pass the check are
// finite and within the limits.

namespace {

using namespace vibe_firmware;

template <std::size_t kSize, typename Report>
bool roundTrip(const std::uint8_t* data, std::size_t size, Report& report) {
  if (!unpack(data, size, report)) return false;
  std::uint8_t packed[kSize];
  require(size == kSize && pack(report, packed) == kSize && std::memcmp(packed, data, kSize) == 0);
  return true;
}

void checkParameters(const ParameterReport& report) {
  const std::array<AxisConfig, kAxisCount> configs{};
  if (validate(configs, report.axes).refusal != Refusal::None) return;
  for (const AxisParameters& p : report.axes) {
    require(p.stiffness >= 0 && p.stiffness <= maxStiffness(configs[0], p.damping) * 1.001F + 1e-6F);
    require(p.damping >= 0 && p.damping <= maxDamping(configs[0], p.stiffness) * 1.001F + 1e-6F);
    require(std::fabs(p.torque) <= configs[0].torque_limit && p.torque_limit <= configs[0].torque_limit);
    require(std::isfinite(p.position));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  InputReport input;
  ParameterReport parameters;
  StatusReport status;
  AxisReport axis;
  roundTrip<kInputReportSize>(data, size, input);
  roundTrip<kStatusReportSize>(data, size, status);
  roundTrip<kAxisReportSize>(data, size, axis);
  if (roundTrip<kParameterReportSize>(data, size, parameters)) checkParameters(parameters);
  return 0;
}
