#pragma once
#include "vibe_hardware/gamepad/pad_state.hpp"

namespace vibe::hardware {

/// Where the events of a pad come from; what a test replaces.
class EventPort {
 public:
  enum class Status {
    Event,    ///< `event` is the next event
    Dropped,  ///< the kernel's queue has overflown and events are lost (SYN_DROPPED): go on with resync
    Empty,    ///< nothing waits; with resync: the state is up to date again
    Gone      ///< the device has been unplugged
  };
  virtual ~EventPort() = default;

  /// Never waits.
  /// @param resync  after Dropped: events that bring the state from before the loss to the present one
  virtual Status next(bool resync, PadEvent& event) = 0;
};

}  // namespace vibe::hardware
