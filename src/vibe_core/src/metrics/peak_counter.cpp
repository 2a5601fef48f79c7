#include "vibe_core/metrics/peak_counter.hpp"

#include <algorithm>

namespace vibe {
namespace {
constexpr double kFall = 0.2;  // share of a peak by which the speed rises and falls around it
}  // namespace

void PeakCounter::add(double speed) {
  if (rising_) {
    extreme_ = std::max(extreme_, speed);
    if (extreme_ < threshold_ || speed > (1 - kFall) * extreme_) return;
    ++count_;
  } else {
    extreme_ = std::min(extreme_, speed);
    if (extreme_ > (1 - kFall) * speed) return;
  }
  rising_ = !rising_;
  extreme_ = speed;
}

void PeakCounter::finish() {
  if (rising_ && extreme_ >= threshold_) ++count_;
  rising_ = true;
  extreme_ = 0;
}

}  // namespace vibe
