#include "vibe_hardware/crtk/tool_trail.hpp"

#include <algorithm>
#include <string>

#include "vibe_hardware/gamepad/pad_mapping.hpp"

namespace vibe::hardware {

double unnoticed(int joint) {
  return jointUnit(joint) == std::string("m") ? 0.5e-3 : 0.5 * M_PI / 180;
}

void resumeTrail(double position, JointTrail& joint) {
  joint.follows = joint.seen = position;
  joint.low[0] = std::min(joint.low[0], position);
  joint.high[0] = std::max(joint.high[0], position);
}

bool isKnown(const JointTrail& joint, bool live) {
  return live || joint.moves;
}

bool movedByOthers(int index, double news, bool live, JointTrail& joint) {
  joint.moves |= news != joint.seen;
  joint.seen = news;
  if (!isKnown(joint, live)) return false;
  const double near = unnoticed(index);
  return news < std::min(joint.low[0], joint.low[1]) - near || news > std::max(joint.high[0], joint.high[1]) + near;
}

void extendTrail(const ToolLimits& limits, const std::array<double, kJointCount>& commanded, double now, double dt,
                 ToolTrail& trail) {
  const bool next = now >= trail.period_end;
  if (next) trail.period_end = now + kTrailPeriod;
  for (std::size_t j = 0; j < trail.joints.size(); ++j) {
    JointTrail& joint = trail.joints[j];
    const double reach = limits[j].velocity * dt;
    joint.follows += std::clamp(commanded[j] - joint.follows, -reach, reach);
    if (next) joint.low = {joint.follows, joint.low[0]}, joint.high = {joint.follows, joint.high[0]};
    joint.low[0] = std::min(joint.low[0], joint.follows);
    joint.high[0] = std::max(joint.high[0], joint.follows);
  }
}

}  // namespace vibe::hardware
