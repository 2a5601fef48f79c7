#include "vibe_hardware/driver/scope_buttons.hpp"

namespace vibe::hardware {

bool ScopeButtons::take(DeviceKind device, std::uint16_t bits) {
  bits_[static_cast<std::size_t>(device)] = bits;
  const auto before = pressed_;
  for (std::size_t b = 0; b < pressed_.size(); ++b) {
    const auto& button = calibration_.buttons[b];
    pressed_[b] = button && isPressed(*button) ? 1 : 0;
  }
  return pressed_ != before;
}

}  // namespace vibe::hardware
