#pragma once

#include "vibe_firmware/core/input_device.hpp"
#include "vibe_firmware/protocol/device_function.hpp"

namespace vibe_firmware {

/// The input device as a HID device. tick() belongs to the sampling interrupt. No report can be set.
class InputFunction final : public DeviceFunction<InputConfig> {
 public:
  /// @param serial  ASCII, at most 126 characters; the text must outlive the object
  explicit InputFunction(const InputConfig& config, const char* serial = "0");

  /// One tick of the 1 kHz sampling.
  void tick(const HapticSample& sample);

  void hostGone() {}  ///< nothing moves by itself

  /// Of the sampling. Only between two ticks.
  const InputState& state() const { return state_; }

 private:
  InputState state_;  // of the sampling interrupt
};

}  // namespace vibe_firmware
