#include "vibe_firmware/protocol/input_function.hpp"

#include "vibe_firmware/protocol/descriptors.hpp"

namespace vibe_firmware {
namespace {

constexpr auto kInputDevice = deviceDescriptor(kInputProductId);
constexpr auto kInputConfiguration = configurationDescriptor(sizeof kInputReportDescriptor);

}  // namespace

InputFunction::InputFunction(const InputConfig& config, const char* serial)
    : DeviceFunction(
          config,
          {bytesOf(kInputDevice), bytesOf(kInputConfiguration), bytesOf(kInputReportDescriptor), "ViBE input device"},
          serial) {}

void InputFunction::tick(const HapticSample& sample) {
  step(config_, sample, state_);
  publish(state_.flags, state_);
}

}  // namespace vibe_firmware
