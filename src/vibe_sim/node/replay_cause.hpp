#pragma once
#include <vibe_msgs/SessionInfo.h>

#include <string>

namespace vibe::sim {

/// What of the information was edited after the recording, such as "the scene"; empty if nothing was.
std::string findEdit(const vibe_msgs::SessionInfo& info);

/// Why another model is built here.
std::string causeOfModel(const vibe_msgs::SessionInfo& info);

/// Why the state differs although model and inputs are the recorded ones: another version, machine or arithmetic.
std::string causeOfState(const vibe_msgs::SessionInfo& info);

}  // namespace vibe::sim
