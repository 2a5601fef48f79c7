#pragma once
#include <vector>

namespace vibe {

/// Processor time of the calling thread so far [s].
double threadCpuTime();
/// Keeps the calling thread on the processor it runs on. @return false where the system does not allow it
bool pinThread();

/// Of a set of times, all in the same unit; NaN for an empty set.
struct TimeSummary {
  double least = 0, median = 0;
};
TimeSummary summarise(std::vector<double> times);

}  // namespace vibe
