#include "events/emit_event.hpp"

namespace vibe {

Event& emitEvent(Event::Kind kind, double time, int particle, double value, std::vector<Event>& events) {
  Event& event = events.emplace_back();
  event.kind = kind;
  event.time = time;
  event.particle = particle;
  event.value = value;
  return event;
}

Event& reject(int command, RejectReason reason, double time, std::vector<Event>& events) {
  Event& event = emitEvent(Event::Kind::Rejected, time, -1, command, events);
  event.reason = reason;
  return event;
}

}  // namespace vibe
