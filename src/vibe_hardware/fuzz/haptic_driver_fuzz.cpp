// sources: src/driver/report_stream.cpp ../vibe_core/src/clocks/device_clock.cpp src/driver/device_connection.cpp
// sources: src/driver/device_driver.cpp src/driver/haptic_driver.cpp src/driver/joint_scale.cpp
// sources: src/hid/report_descriptor.cpp ../vibe_core/src/files/number_text.cpp
// includes: ../vibe_firmware/fuzz
#include "vibe_hardware/driver/haptic_driver.hpp"

#include <cmath>

#include "fuzz_bus.hpp"
#include "vibe_firmware/core/passivity.hpp"

// A device of which every report and every answer is made up: nothing gets out of poll(), times are finite and go
// forwards, and whatever is sent to the device is passive on the axes that the device says it has.

namespace {

using namespace vibe;
using namespace vibe::hardware;

void requirePassive(const vibe_firmware::ParameterReport& report,
                    const std::array<vibe_firmware::AxisConfig, 2>& axes) {
  require(vibe_firmware::validate(axes, report.axes).refusal == vibe_firmware::Refusal::None);
}

/// A finite number of any size.
double anyNumber(FuzzInput& input) {
  const int exponent = input.byte() % 40 - 20;
  return (input.byte() - 128.0) * std::pow(10.0, exponent);
}

HapticDriver::Targets anyTargets(FuzzInput& input) {
  HapticDriver::Targets targets{};
  for (JointSpring& t : targets) {
    t = {anyNumber(input), anyNumber(input), std::abs(anyNumber(input)), std::abs(anyNumber(input)), anyNumber(input)};
  }
  return targets;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  FuzzInput input(data, size);
  FuzzBus bus(input);
  bus.sent = requirePassive;
  double last = 0;
  const auto sample = [&](const DeviceSample& s) {
    require(std::isfinite(s.time) && s.time > last && s.time <= bus.now + 0.01);
    last = s.time;
    for (const double position : s.position) require(std::isfinite(position));
  };
  DeviceDriver::Callbacks callbacks{sample, [](const DeviceConnection&) {}, [](double) {},
                                    [](Severity, const std::string& sentence) { require(!sentence.empty()); }};
  HapticDriver driver(
      bus, {vibe_firmware::kVendorId, vibe_firmware::kHapticProductId, ""}, [&] { return bus.now; }, callbacks);
  while (!input.empty()) {
    const std::uint8_t choice = input.byte();
    if (choice < 40) driver.setTarget(anyTargets(input));
    if (choice == 40) driver.release();
    bus.now += 1e-3 * (choice % 8);
    driver.poll(0.004);
    if (driver.device().connection() == nullptr) bus.now += 0.1;
    require(driver.device().statistics().rate <= 256);
  }
  return 0;
}
