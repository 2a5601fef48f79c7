#include "vibe_hardware/gamepad/event_reader.hpp"

namespace vibe::hardware {
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
