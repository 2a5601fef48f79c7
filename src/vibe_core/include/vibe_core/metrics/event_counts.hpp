#pragma once
#include <array>
#include <vector>

#include "vibe_core/events/event.hpp"

namespace vibe {

/// How often each kind of event has happened. Whatever counts events reads this.
class EventCounts {
 public:
  /// @param events  of one step
  void record(const std::vector<Event>& events) {
    for (const Event& event : events) ++counts_[static_cast<std::size_t>(event.kind)];
  }

  int of(Event::Kind kind) const { return counts_[static_cast<std::size_t>(kind)]; }

  /// Of all kinds.
  long total() const {
    long sum = 0;
    for (int count : counts_) sum += count;
    return sum;
  }

 private:
  std::array<int, kEventKindCount> counts_{};
};

}  // namespace vibe
