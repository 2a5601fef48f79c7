#include "camera/interval_gaps.hpp"

#include <algorithm>
#include <cmath>

namespace vibe::vision {
namespace {

constexpr int kWindow = 30;
constexpr double kMost = 1e6;  // frames of one gap; more is no gap but a clock that was set

}  // namespace

std::uint64_t IntervalGaps::advance(double stamp) {
  const double interval = stamp - last_;
  const bool is_first = last_ == 0;
  last_ = stamp;
  if (is_first || interval <= 0) return 0;
  const double missed = std::round(interval / period_) - 1;
  learn(interval);
  return missed < 1 || missed > kMost ? 0 : static_cast<std::uint64_t>(missed);
}

void IntervalGaps::learn(double interval) {
  shortest_ = intervals_ == 0 ? interval : std::min(shortest_, interval);
  if (++intervals_ < kWindow) return;
  period_ = shortest_;
  intervals_ = 0;
}

}  // namespace vibe::vision
