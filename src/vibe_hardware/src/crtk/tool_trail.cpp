#include "vibe_hardware/crtk/tool_trail.hpp"

#include <algorithm>
#include <cmath>

#include "vibe_core/input/joint_unit.hpp"

namespace vibe::hardware {

double unnoticed(int joint) {
  return isPrismatic(joint) ? 0.5e-3 : 0.5 * M_PI / 180;
}

void resumeTrail(double position, JointTrail& joint) {
  joint.follows = joint.seen = position;
  joint.low[0] = std::min(joint.low[0], position);
  joint.high[0] = std::max(joint.high[0], position);
}

bool movedByOthers(int index, double news, bool rests, JointTrail& joint) {
  const double low = std::min(joint.low[0], joint.low[1]), high = std::max(joint.high[0], joint.high[1]);
  const auto outside = [&](double position) { return std::max({0.0, low - position, position - high}); };
  const double before = outside(joint.seen), now = outside(news);
  joint.seen = news;
  return now > unnoticed(index) && (now > before || rests);
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
    if (std::abs(commanded[j] - joint.rest) > unnoticed(static_cast<int>(j)))
      joint.rest = commanded[j], joint.rest_begin = now;
  }
}

}  // namespace vibe::hardware
