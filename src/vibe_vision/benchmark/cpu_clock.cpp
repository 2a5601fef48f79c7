#include "cpu_clock.hpp"

#include <sched.h>

#include <algorithm>
#include <limits>

namespace vibe::vision {

bool pinThread() {
  const int processor = sched_getcpu();
  if (processor < 0) return false;
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(static_cast<std::size_t>(processor), &set);
  return sched_setaffinity(0, sizeof set, &set) == 0;
}

TimeSummary summarise(std::vector<double> times) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  if (times.empty()) return {nan, nan};
  std::sort(times.begin(), times.end());
  return {times.front(), times[times.size() / 2]};
}

}  // namespace vibe::vision
