#pragma once
#include <functional>

namespace vibe::node {

/// Waits for an answer of the ROS master. Call it after ros::init() and before the first NodeHandle, which waits for a
/// master for ever and hears no signal meanwhile. Says once that it waits.
/// @param patience  [s]
/// @param stopped   asked ten times a second; the wait ends where it is true; empty: never
/// @return whether there is a master; false: stopped
/// @throws Error when none has answered in time
bool waitForMaster(double patience, const std::function<bool()>& stopped = {});

/// Whether the command line has --help or -h.
bool asksForHelp(int argc, const char* const* argv);

}  // namespace vibe::node
