#pragma once
#include <array>

#include "vibe_core/input/step_input.hpp"
#include "vibe_hardware/gamepad/pad_mapping.hpp"

namespace vibe::hardware {

/// Where a joint of the tool may be that gets commands: it follows them no faster than its limit, and news of it are
/// late. What is elsewhere has been moved by somebody else.
struct JointTrail {
  double follows = 0;                   ///< where it is if it follows at once [m], [rad]
  std::array<double, 2> low{}, high{};  ///< of that, in this and in the last period of kTrailPeriod [m], [rad]
  double seen = 0;                      ///< newest news [m], [rad]
  bool moves = false;                   ///< news have changed since the arm engaged
};
constexpr double kTrailPeriod = 0.1;  ///< so news may be that late [s]; design choice

struct ToolTrail {
  std::array<JointTrail, kJointCount> joints;
  double period_end = 0;  ///< [s]
};

/// What a person does not notice when a joint goes on from elsewhere [m], [rad]; design choice.
double unnoticed(int joint);

/// Goes on from a place. News of where the joint was sent before may still come.
void resumeTrail(double position, JointTrail& joint);
/// Whether news tell where a joint is. @param live  they come all the time; else they count when they change
bool isKnown(const JointTrail& joint, bool live);
/// Whether somebody else has moved a joint.
bool movedByOthers(int index, double news, bool live, JointTrail& joint);
/// Goes on with what is commanded now. @param dt  since the last one [s]
void extendTrail(const ToolLimits& limits, const std::array<double, kJointCount>& commanded, double now, double dt,
                 ToolTrail& trail);

}  // namespace vibe::hardware
