#pragma once
#include <array>

#include "vibe_core/input/step_input.hpp"
#include "vibe_hardware/gamepad/pad_mapping.hpp"

namespace vibe::hardware {

/// Where a joint of the tool may be that obeys commands, no faster than its limit, and of which news are late.
struct JointTrail {
  double follows = 0;                   ///< where it is if it obeys at once [m], [rad]
  std::array<double, 2> low{}, high{};  ///< of that, in this and in the last period of kTrailPeriod [m], [rad]
  double seen = 0;                      ///< newest news [m], [rad]
  double rest = 0, rest_begin = 0;      ///< where the command has been since then, but for what nobody notices [s]
};
constexpr double kTrailPeriod = 0.1;  ///< so news may be that late [s]; design choice
constexpr double kTrailRest = 0.5;    ///< commands that have not moved for so long give way [s]; design choice

struct ToolTrail {
  std::array<JointTrail, kJointCount> joints;  ///< by vibe::Joint
  double period_end = 0;                       ///< [s]
};

/// What a person does not notice when a joint goes on from elsewhere [m], [rad]; design choice.
double unnoticed(int joint);

/// Goes on from a place. News of where the joint was sent before may still come.
void resumeTrail(double position, JointTrail& joint);
/// Whether somebody else moves a joint: it leaves the trail, or it is elsewhere and the command rests.
/// @param rests  to be true for a command that has rested for kTrailRest, if a joint that does not move says anything
bool movedByOthers(int index, double news, bool rests, JointTrail& joint);
/// Goes on with what is commanded now. @param dt  since the last one [s]
void extendTrail(const ToolLimits& limits, const std::array<double, kJointCount>& commanded, double now, double dt,
                 ToolTrail& trail);

}  // namespace vibe::hardware
