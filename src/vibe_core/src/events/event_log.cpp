#include "vibe_core/events/event_log.hpp"

#include "vibe_core/state/state.hpp"

namespace vibe {

Event& EventLog::emit(Event::Kind kind, int particle, double value) const {
  Event& event = events_.emplace_back();
  event.kind = kind;
  event.time = state_.time;
  event.particle = particle;
  event.value = value;
  return event;
}

Event& EventLog::reject(int command, RejectReason reason) const {
  Event& event = emit(Event::Kind::Rejected, -1, command);
  event.reason = reason;
  return event;
}

}  // namespace vibe
