#pragma once
#include <memory>
#include <string>
#include <vector>

#include "vibe_firmware/protocol/haptic_function.hpp"
#include "vibe_hardware/emulator/axis_plant.hpp"
#include "vibe_hardware/emulator/emulated_device.hpp"
#include "vibe_hardware/emulator/emulated_encoder.hpp"

namespace vibe::hardware {

/// The haptic device: two axes with motors, the firmware, and a hand that holds them.
class EmulatedHaptic : public EmulatedDevice {
 public:
  using Plants = std::array<AxisPlant, vibe_firmware::kAxisCount>;

  /// @param config  of the firmware. The encoder steps of the plants have to be those of its axes.
  EmulatedHaptic(const vibe_firmware::HapticConfig& config, const Plants& plants, std::string serial);

  void tick(const DeviceMotion& motion) override;
  bool nextReport(std::uint8_t (&bytes)[vibe_firmware::kInputReportSize]) override;
  vibe_firmware::HidFunction& function() override { return *firmware_; }
  void restart() override;

  const AxisPlant& plant(std::size_t axis) const { return plants_[axis]; }
  const AxisPlantState& axis(std::size_t axis) const { return axes_[axis]; }
  const vibe_firmware::HapticFunction& firmware() const { return *firmware_; }
  /// Torques that the firmware asked for in the last tick [N m].
  const std::array<float, vibe_firmware::kAxisCount>& torques() const { return torques_; }

 private:
  vibe_firmware::HapticConfig config_;
  Plants plants_;
  std::string serial_;
  std::array<AxisPlantState, vibe_firmware::kAxisCount> axes_{};
  std::vector<EmulatedEncoder> encoders_;
  std::unique_ptr<vibe_firmware::HapticFunction> firmware_;
  std::array<float, vibe_firmware::kAxisCount> torques_{};
  std::uint32_t ticks_ = 0;
};

}  // namespace vibe::hardware
