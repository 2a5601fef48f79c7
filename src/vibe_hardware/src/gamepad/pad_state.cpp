#include "vibe_hardware/gamepad/pad_state.hpp"

#include <algorithm>

#include <libevdev/libevdev.h>

namespace vibe::hardware {

double PadAxis::deflection() const {
  if (maximum <= minimum || !is_known) return 0;
  const double low = minimum, high = maximum;
  return std::clamp((2.0 * value - low - high) / (high - low), -1.0, 1.0);
}

double PadAxis::pressure() const {
  return is_known ? 0.5 * (deflection() + 1) : 0;
}

void PadState::apply(const PadEvent& event) {
  if (event.type == EV_ABS) {
    const auto axis = axes.find(event.code);
    if (axis == axes.end()) return;
    axis->second.value = event.value;
    axis->second.is_known = true;
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

namespace {

constexpr int kMostEvents = 20000;  // a device that floods must not stop the program; the rest waits for the next call

}  // namespace

bool EventReader::update() {
  bool resync = false;
  for (int count = 0; count < kMostEvents; ++count) {
    PadEvent event;
    switch (port_.next(resync, event)) {
      case EventPort::Status::Event:
        take(event);
        break;
      case EventPort::Status::Dropped:
        if (!resync) ++drop_count_;
        resync = true;
        break;
      case EventPort::Status::Empty:
        if (!resync) return true;
        resync = false;  // the state is complete; new events may wait behind it
        break;
      case EventPort::Status::Gone:
        return false;
    }
  }
  return true;
}

void EventReader::take(const PadEvent& event) {
  ++event_count_;
  state_.apply(event);
  if (listener_) listener_(event);
}

}  // namespace vibe::hardware
