#pragma once
#include <vector>

#include "vibe_core/events/event.hpp"

namespace vibe {

struct State;

/// Where a step writes down what happens. An event gets the time that the state has when it is emitted: up to the solve
/// that of the start of the step, after it that of its end. A pair of references, to be passed by value.
class EventLog {
 public:
  /// @param state   whose clock counts; must outlive this, as `events` must
  /// @param events  are appended to
  EventLog(const State& state, std::vector<Event>& events) : state_(state), events_(events) {}

  /// Appends an event. The caller sets through the reference what else the kind carries, before the next event.
  Event& emit(Event::Kind kind, int particle = -1, double value = 0) const;

  /// Appends a rejection.
  /// @param command  Button, or -1: the closing of the needle arm
  Event& reject(int command, RejectReason reason) const;

 private:
  const State& state_;
  std::vector<Event>& events_;
};

}  // namespace vibe
