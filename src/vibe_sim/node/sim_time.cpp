#include "sim_time.hpp"

#include <cmath>

namespace vibe::sim {

std::int64_t stampOf(std::int64_t origin, std::int64_t step, double period) {
  return origin + std::llround(static_cast<double>(step) * period * 1e9);
}

std::int64_t stepAt(std::int64_t origin, std::int64_t stamp, double period) {
  return std::llround(static_cast<double>(stamp - origin) / (period * 1e9));
}

std::int64_t stepsIn(double duration, double period) {
  return std::llround(duration / period);
}

void TimeLine::continueWith(std::int64_t old_step, std::int64_t new_step, double new_period) {
  if (new_period == period_) {
    shift_ += old_step + 1 - new_step;
    return;
  }
  origin_ = stamp(old_step + 1);
  period_ = new_period;
  shift_ = -new_step;
}

}  // namespace vibe::sim
