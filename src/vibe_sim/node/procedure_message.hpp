#pragma once
#include <vibe_msgs/ProcedureState.h>

#include <string>

#include "publishers.hpp"
#include "session.hpp"

namespace vibe {

vibe_msgs::ProcedureState makeProcedureState(const Session& session, const RunStatus& status);

/// What of the procedure's state must reach listeners at once when it changes: phase, counts, scene, pause.
std::string kindOf(const Session& session, const RunStatus& status);

}  // namespace vibe
