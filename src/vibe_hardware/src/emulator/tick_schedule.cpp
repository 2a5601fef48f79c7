#include "vibe_hardware/emulator/tick_schedule.hpp"

#include <algorithm>
#include <cmath>

namespace vibe::hardware {

double TickSchedule::next() const {
  return origin_ + tick_ * static_cast<double>(ticks_);
}

int TickSchedule::due(double now) {
  delay_ = std::max(0.0, now - next());
  worst_delay_ = std::max(worst_delay_, delay_);
  if (delay_ > kDrop) {
    dropped_ += delay_;
    origin_ += delay_;
  }
  if (now < next()) return 0;
  const auto count = static_cast<int>(std::min((now - next()) / tick_, kMaxBurst - 1.0)) + 1;
  ticks_ += count;
  return count;
}

}  // namespace vibe::hardware
