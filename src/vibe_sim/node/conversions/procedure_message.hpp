#pragma once

#include <string>

#include <vibe_msgs/ProcedureState.h>
#include <vibe_msgs/SkillMetrics.h>

#include "publishing/publishers.hpp"
#include "simulation/timed_simulation.hpp"

namespace vibe::sim {

/// Where the procedure stands, from the present state.
vibe_msgs::ProcedureState makeProcedureState(const Session& session, const RunStatus& status);

/// The measures of skill so far.
vibe_msgs::SkillMetrics makeSkillMetrics(const Session& session);

/// Changes with whatever must be published at once: scene, pause, tool state, held particles, any event but contact.
std::string kindOf(const Session& session, const RunStatus& status);

}  // namespace vibe::sim
