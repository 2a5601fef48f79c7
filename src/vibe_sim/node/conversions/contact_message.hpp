#pragma once

#include <vibe_msgs/ToolContacts.h>

#include "simulation/timed_simulation.hpp"

namespace vibe::sim {

/// Where the tool touches and holds the wall in the last step. @param simulation  of a scene with a tool
vibe_msgs::ToolContacts makeToolContacts(const TimedSimulation& simulation);

}  // namespace vibe::sim
