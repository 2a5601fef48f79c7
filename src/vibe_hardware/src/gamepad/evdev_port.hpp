#pragma once
#include "gamepad/evdev_device.hpp"
#include "vibe_hardware/gamepad/event_port.hpp"

namespace vibe::hardware {

/// Events of a device of the kernel, read through libevdev.
class EvdevPort : public EventPort {
 public:
  explicit EvdevPort(libevdev& device) : device_(device) {}
  Status next(bool resync, PadEvent& event) override;

 private:
  libevdev& device_;
};

}  // namespace vibe::hardware
