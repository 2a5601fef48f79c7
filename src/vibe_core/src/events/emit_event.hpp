#pragma once
#include <vector>

#include "vibe_core/events/event.hpp"

namespace vibe {

/// Appends an event. The caller sets through the reference what else the kind carries, before the next event.
Event& emitEvent(Event::Kind kind, double time, int particle, double value, std::vector<Event>& events);

/// Appends a rejection.
/// @param command  Button, or -1: the closing of the needle arm
Event& reject(int command, RejectReason reason, double time, std::vector<Event>& events);

}  // namespace vibe
