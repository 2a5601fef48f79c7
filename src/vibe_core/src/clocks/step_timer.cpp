#include "vibe_core/clocks/step_timer.hpp"

#include <time.h>

#include <algorithm>
#include <cmath>

#include "arithmetic/elementary.hpp"

namespace vibe {
namespace {

constexpr double kShortest = 1e-6;  // [s]
const double kLogRatio = math::log(1.01);

double readClock(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

void DurationHistogram::add(double seconds) {
  const double position = seconds > kShortest ? math::log(seconds / kShortest) / kLogRatio : 0.0;
  ++bins_[std::min(static_cast<int>(std::min(position, 1e6)), kBins - 1)];
  ++count_;
  sum_ += seconds;
  max_ = std::max(max_, seconds);
}

void DurationHistogram::clear() {
  *this = DurationHistogram();
}

double DurationHistogram::quantile(double q) const {
  if (count_ == 0) return 0;
  const auto rank = static_cast<std::uint64_t>(std::ceil(std::clamp(q, 0.0, 1.0) * static_cast<double>(count_)));
  std::uint64_t seen = 0;
  int bin = 0;
  while (bin < kBins - 1 && (seen += bins_[bin]) < std::max<std::uint64_t>(rank, 1)) ++bin;
  // the middle of the bin halves the maximum error; no quantile exceeds the maximum, which is exact
  return std::min(kShortest * math::exp((bin + 0.5) * kLogRatio), max_);
}

void StepTimer::start() {
  wall_start_ = steadyTime();
  cpu_start_ = threadCpuTime();
}

void StepTimer::stop() {
  last_cpu = threadCpuTime() - cpu_start_;
  last_wall = steadyTime() - wall_start_;
  cpu.add(last_cpu);
  wall.add(last_wall);
}

double threadCpuTime() {
  return readClock(CLOCK_THREAD_CPUTIME_ID);
}

double steadyTime() {
  return readClock(CLOCK_MONOTONIC);
}

}  // namespace vibe
