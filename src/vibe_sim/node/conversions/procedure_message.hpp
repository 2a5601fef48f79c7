#pragma once

#include <string>

#include <vibe_msgs/ProcedureEvent.h>
#include <vibe_msgs/ProcedureState.h>
#include <vibe_msgs/SkillMetrics.h>

#include "simulation/timed_simulation.hpp"

namespace vibe::sim {

vibe_msgs::ProcedureEvent makeEvent(const Event& event, std::int64_t stamp);
/// A warning of the node itself, such as an input that it cannot use.
vibe_msgs::ProcedureEvent makeWarning(const std::string& text, std::int64_t stamp);

/// What the tool does to the organ at the moment: "grip", "insufflation", "contact" or "free".
const char* toolStateOf(const State& state, const StepInput& input);

/// Where the procedure stands, from the present state.
vibe_msgs::ProcedureState makeProcedureState(const TimedSimulation& simulation, const RunStatus& status);

/// The measures of skill so far.
vibe_msgs::SkillMetrics makeSkillMetrics(const TimedSimulation& simulation);

/// Changes with whatever must be published at once: scene, pause, tool state, held particles, any event but contact.
std::string kindOf(const TimedSimulation& simulation, const RunStatus& status);

}  // namespace vibe::sim
