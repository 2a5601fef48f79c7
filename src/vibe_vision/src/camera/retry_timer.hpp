#pragma once
#include <algorithm>

#include "camera/host_time.hpp"

namespace vibe::vision {

/// Lets an attempt through at most once per second. The first is let through at once.
class RetryTimer {
 public:
  /// Waits for the next attempt, at most for the timeout. @return whether it may be made now
  bool wait(double timeout) {
    sleepFor(std::min(timeout, next_ - steadyTime()));
    if (steadyTime() < next_) return false;
    next_ = steadyTime() + kPeriod;
    return true;
  }

 private:
  static constexpr double kPeriod = 1;  // [s]
  double next_ = 0;
};

}  // namespace vibe::vision
