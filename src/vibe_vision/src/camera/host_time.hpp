#pragma once

#include <algorithm>
#include <chrono>
#include <thread>

#include "vibe_core/clocks/step_timer.hpp"  // steadyTime()

namespace vibe::vision {

/// Unix time [s].
inline double hostTime() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

inline void sleepFor(double duration) {
  if (duration > 0) std::this_thread::sleep_for(std::chrono::duration<double>(duration));
}

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
