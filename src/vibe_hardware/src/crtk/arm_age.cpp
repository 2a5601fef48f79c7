#include "vibe_hardware/crtk/arm_age.hpp"

#include <algorithm>
#include <cstdio>

namespace vibe::hardware {

bool getsForces(const TeleopMapping& mapping) {
  return mapping.force_scale != 0 && std::any_of(mapping.joints.begin(), mapping.joints.begin() + kScopeJointCount,
                                                 [](const HandJoint& joint) { return joint.coordinate >= 0; });
}

double largestDelay(const TeleopMapping& mapping) {
  double delay = 0;
  for (std::size_t j = 0; j < kScopeJointCount; ++j)
    if (mapping.joints[j].coordinate >= 0) delay = std::max(delay, mapping.joints[j].port.delay);
  return delay;
}

std::string inMilliseconds(double time) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g ms", 1e3 * time);
  return text;
}

Lateness latenessOf(const TeleopMapping& mapping, double age) {
  if (age > mapping.timeout)
    return {"timeout", "and the arm counts as silent after " + inMilliseconds(mapping.timeout) +
                           "; make the connection quicker, synchronise the clocks, or raise 'timeout' and 'delay' "
                           "below 'arm' in the mapping."};
  if (!getsForces(mapping) || age <= largestDelay(mapping)) return {};
  return {"delay", "longer than the mapping says (" + inMilliseconds(largestDelay(mapping)) +
                       "). Forces are reckoned to take as long; if the way back takes longer still, the arm may give "
                       "energy; write a longer 'delay' below 'arm' in the mapping."};
}

}  // namespace vibe::hardware
