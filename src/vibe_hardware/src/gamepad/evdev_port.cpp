#include "gamepad/evdev_port.hpp"

#include <cerrno>

namespace vibe::hardware {

EventPort::Status EvdevPort::next(bool resync, PadEvent& event) {
  input_event raw{};
  const unsigned mode = resync ? LIBEVDEV_READ_FLAG_SYNC : LIBEVDEV_READ_FLAG_NORMAL;
  const int status = libevdev_next_event(&device_, mode, &raw);
  if (status == -EAGAIN || status == -EINTR) return Status::Empty;
  if (status < 0) return Status::Gone;
  // in normal mode this status announces the loss; in sync mode every event has it
  if (status == LIBEVDEV_READ_STATUS_SYNC && !resync) return Status::Dropped;
  event.time = static_cast<double>(raw.input_event_sec) + 1e-6 * static_cast<double>(raw.input_event_usec);
  event.type = raw.type;
  event.code = raw.code;
  event.value = raw.value;
  return Status::Event;
}

}  // namespace vibe::hardware
