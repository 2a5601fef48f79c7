#pragma once
#include <optional>
#include <string>
#include <vector>

#include "vibe_core/metrics/session_metrics.hpp"
#include "vibe_core/state/procedure_state.hpp"

namespace vibe {

/// A measure of a session by name: a name as in docs/metrics.md and vibe_msgs/SkillMetrics.
struct Measure {
  std::string name;
  std::string unit;             ///< SI, as in scene files; "1" for counts and shares
  std::optional<double> value;  ///< empty: the session so far does not define it
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

}  // namespace vibe
