#pragma once
#include <memory>
#include <string>
#include <vector>

#include "vibe_firmware/protocol/input_function.hpp"
#include "vibe_hardware/emulator/emulated_device.hpp"
#include "vibe_hardware/emulator/emulated_encoder.hpp"

namespace vibe::hardware {

/// The input device: two wheels and buttons. It has no motors, so the wheels are where the hand wants them to be.
class EmulatedInput : public EmulatedDevice {
 public:
  EmulatedInput(const vibe_firmware::InputConfig& config, std::string serial);

  void tick(const DeviceMotion& motion) override;
  bool nextReport(std::uint8_t (&bytes)[vibe_firmware::kInputReportSize]) override;
  vibe_firmware::HidFunction& function() override { return *firmware_; }
  void restart() override;

 private:
  vibe_firmware::InputConfig config_;
  std::string serial_;
  std::vector<EmulatedEncoder> encoders_;
  std::unique_ptr<vibe_firmware::InputFunction> firmware_;
  std::uint32_t ticks_ = 0;
};

}  // namespace vibe::hardware
