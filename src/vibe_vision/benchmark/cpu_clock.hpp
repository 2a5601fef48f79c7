#pragma once
#include <vector>

#include "vibe_core/common/step_timer.hpp"  // threadCpuTime()

namespace vibe::vision {

/// Keeps the calling thread on the processor it runs on. @return false where the system does not allow it
bool pinThread();

/// Of a set of times, all in the same unit; NaN for an empty set.
struct TimeSummary {
  double least = 0, median = 0;
};
TimeSummary summarise(std::vector<double> times);

}  // namespace vibe::vision
