#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "vibe_core/events/event.hpp"

namespace vibe {

/// How often each kind of event has happened.
class EventCounts {
 public:
  void record(const std::vector<Event>& events) {
    for (const Event& event : events) ++counts_[static_cast<std::uint8_t>(event.kind)];
  }

  std::uint32_t of(Event::Kind kind) const { return counts_[static_cast<std::uint8_t>(kind)]; }

  std::uint64_t total() const {
    std::uint64_t sum = 0;
    for (std::uint32_t count : counts_) sum += count;
    return sum;
  }

 private:
  std::array<std::uint32_t, 256> counts_{};  // a kind is one byte
};

}  // namespace vibe
