#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "vibe_core/metrics/event_counts.hpp"
#include "vibe_core/metrics/measures.hpp"

namespace vibe {

/// What became of a goal of a protocol.
struct GoalOutcome {
  std::string goal;  ///< one line
  bool reached = false;
  std::string reason;  ///< one sentence; "not ended" if the session ended before
};

/// What is written of a session that has ended.
struct SessionOutcome {
  std::vector<Measure> measures;
  EventCounts events;
  std::vector<GoalOutcome> goals;  ///< empty without a protocol
  std::int64_t steps = 0;
  std::uint64_t state_hash = 0;
};

/// One JSON object: `measures` (name: {value, unit}; a value that is not defined is null), `events` (count by kind, all
/// kinds), `goals` (goal, reached, reason), `steps` and `state_hash`. Numbers read back to the same bits.
std::string toJson(const SessionOutcome& outcome);

}  // namespace vibe
