#pragma once
#include <vibe_msgs/SessionInfo.h>
#include <vibe_msgs/StateSnapshot.h>

#include "session.hpp"

namespace vibe::sim {

/// What a session was made with.
vibe_msgs::SessionInfo makeSessionInfo(const Session& session);

vibe_msgs::StateSnapshot makeStateSnapshot(const Session& session);

}  // namespace vibe::sim
