#include "vibe_hardware/crtk/arm_age.hpp"

#include <algorithm>

namespace vibe::hardware {

double largestDelay(const TeleopMapping& mapping) {
  double delay = 0;
  for (std::size_t j = 0; j < kScopeJointCount; ++j)
    if (mapping.joints[j].coordinate >= 0) delay = std::max(delay, mapping.joints[j].port.delay);
  return delay;
}

Lateness latenessOf(const TeleopMapping& mapping, double age) {
  if (age > mapping.timeout)
    return {"timeout", "and the arm counts as silent after " + std::to_string(mapping.timeout) +
                           " s; make the connection quicker, synchronise the clocks, or raise 'timeout' and 'delay' "
                           "below 'arm' in the mapping."};
  if (mapping.force_scale == 0 || age <= largestDelay(mapping)) return {};
  return {"delay", "longer than the mapping says (" + std::to_string(largestDelay(mapping)) +
                       " s). Forces are reckoned to take as long; if the way back takes longer still, the arm may give "
                       "energy; write a longer 'delay' below 'arm' in the mapping."};
}

}  // namespace vibe::hardware
