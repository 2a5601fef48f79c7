#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "vibe_core/events/event.hpp"
#include "vibe_core/metrics/session_metrics.hpp"
#include "vibe_core/state/procedure_state.hpp"

namespace vibe {

/// A measure of a session by name: a name as in docs/metrics.md and vibe_msgs/SkillMetrics.
struct Measure {
  std::string name;             ///< different from all others of its list
  std::string unit;             ///< SI, as in scene files; "1" for counts and shares
  std::optional<double> value;  ///< empty: the session so far does not define it; in `unit`
};

/// All measures of a session that are numbers, always the same names in the same order. Those of a phase have a dot and
/// the phase: `phase_path_length.suture`. Names that the message does not have: those of ProcedureState and of the
/// energy account, `movements` and `share_above` of docs/metrics.md, `bites_full_thickness`, `sets`,
/// `cinch_tension_mean` and `bites_per_5_min`.
/// @param sutures  of the last state; for bites_per_5_min
std::vector<Measure> measuresOf(const SessionMetrics& metrics, const std::vector<Suture>& sutures);

/// The value of that name.
/// @throws Error if there is no such measure
std::optional<double> valueOf(const std::vector<Measure>& measures, const std::string& name);

/// What became of a goal of a protocol.
struct GoalOutcome {
  std::string goal;      ///< one line
  bool reached = false;  ///< false: given up, or the session ended before
  std::string reason;    ///< one sentence; "not ended" if the session ended before
};

/// What is written of a session that has ended.
struct SessionOutcome {
  std::vector<Measure> measures;   ///< those of measuresOf(), then those of goalMeasures()
  EventCounts events;              ///< as in SessionMetrics
  std::vector<GoalOutcome> goals;  ///< empty without a protocol
  std::int64_t steps = 0;          ///< of the last state, see State::step
  std::uint64_t state_hash = 0;    ///< hash() of the last state
};

/// One JSON object: `measures` (name: {value, unit}; a value that is not defined is null), `events` (count by kind, all
/// kinds), `goals` (goal, reached, reason), `steps` and `state_hash`. Numbers read back to the same bits.
std::string toJson(const SessionOutcome& outcome);

}  // namespace vibe
