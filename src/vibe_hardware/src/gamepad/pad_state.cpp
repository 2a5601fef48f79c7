#include "vibe_hardware/gamepad/pad_state.hpp"

#include <libevdev/libevdev.h>

#include <algorithm>

namespace vibe::hardware {

double PadAxis::deflection() const {
  if (maximum <= minimum) return 0;
  const double low = minimum, high = maximum;
  return std::clamp((2.0 * value - low - high) / (high - low), -1.0, 1.0);
}

void PadState::apply(const PadEvent& event) {
  if (event.type == EV_ABS) {
    const auto axis = axes.find(event.code);
    if (axis != axes.end()) axis->second.value = event.value;
  } else if (event.type == EV_KEY) {
    const auto button = buttons.find(event.code);
    if (button == buttons.end()) return;
    const bool down = event.value != 0;  // 2 is the repetition of a key that stays down
    if (down && !button->second.down) ++button->second.presses;
    button->second.down = down;
  }
}

std::string eventCodeName(int type, int code) {
  const char* name = libevdev_event_code_get_name(static_cast<unsigned>(type), static_cast<unsigned>(code));
  return name != nullptr ? name : std::to_string(code);
}

int eventCodeFromName(int type, const std::string& name) {
  return libevdev_event_code_from_name(static_cast<unsigned>(type), name.c_str());
}

}  // namespace vibe::hardware
