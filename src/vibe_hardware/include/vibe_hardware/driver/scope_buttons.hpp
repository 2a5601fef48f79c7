#pragma once
#include <array>
#include <cstdint>

#include "vibe_hardware/driver/calibration.hpp"

namespace vibe::hardware {

/// The six buttons of scope/buttons from the bits of both devices.
class ScopeButtons {
 public:
  explicit ScopeButtons(const Calibration& calibration) : calibration_(calibration) {}

  /// @param bits  of a report; 0 when the device is lost  @return whether one of the six buttons has changed
  bool take(DeviceKind device, std::uint16_t bits);

  const std::array<std::uint8_t, kButtonCount>& pressed() const { return pressed_; }  ///< 1 while pressed
  bool isPressed(const DeviceButton& button) const {
    return (bits_[static_cast<std::size_t>(button.device)] >> button.bit & 1) != 0;
  }

 private:
  Calibration calibration_;
  std::array<std::uint16_t, kDeviceKinds> bits_{};
  std::array<std::uint8_t, kButtonCount> pressed_{};
};

}  // namespace vibe::hardware
