#pragma once
#include <vector>

#include "vibe_core/metrics/session_outcome.hpp"
#include "vibe_core/trainee/trainee.hpp"

namespace vibe {

/// What became of the goals of a trainee, in their order.
std::vector<GoalOutcome> goalOutcomes(const Trainee& trainee);

/// Measures of a protocol: `goals`, `goals_reached` and `sets_as_planned`, the sets whose recognised technique is that
/// of their goal.
/// @param trainee  null: the same names without values
/// @param sets     of the session
std::vector<Measure> goalMeasures(const Trainee* trainee, const std::vector<SetSkill>& sets);

}  // namespace vibe
