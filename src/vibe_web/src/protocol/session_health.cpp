#include "protocol/session_health.hpp"

#include <array>

namespace vibe::web {

namespace {

/// In few steps, because a screen reader reads each sentence that is new.
std::string lasting(double seconds) {
  constexpr std::array<int, 8> kTold = {2, 5, 10, 30, 60, 120, 300, 600};
  int told = kTold.front();
  for (const int each : kTold)
    if (each <= seconds) told = each;
  return "for more than " + std::to_string(told) + " s";
}

}  // namespace

HealthNote noteOf(const SessionHealth& health) {
  if (!health.published)
    return {
        "Nothing publishes tissue/particles; start a simulator or vibe_player with the ROS_MASTER_URI and the "
        "namespace of web_node.",
        true};
  if (health.silence > (health.paused ? kStalePaused : kStale))
    return {"No states " + lasting(health.silence) + "; has the simulator stopped, or does it take that long?", true};
  if (health.paused) return {"The simulator is paused."};
  if (!health.robot)
    return {
        "There is no endoscope: robot_description holds no URDF that can be read; set this parameter to "
        "vibe_description/urdf/scope.urdf."};
  if (!health.base)
    return {
        "There is no endoscope: no message on /tf_static says where scope_base is; a simulator and vibe_player send "
        "it."};
  return {};
}

}  // namespace vibe::web
