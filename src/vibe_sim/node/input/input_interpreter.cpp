#include "input/input_interpreter.hpp"

#include <algorithm>
#include <cmath>

namespace vibe::sim {

namespace {

constexpr double kPeakSpeed = 1.875;  // of the path, over its mean speed

/// Share of the way at a share of the time.
double leastJerk(double s) {
  return s * s * s * (10 - 15 * s + 6 * s * s);
}

}  // namespace

JointMove::JointMove(const JointArray& start, const JointArray& goal, int first, int count,
                     const std::array<JointLimits, kJointCount>& limits, std::int64_t begin)
    : start_(start), first_(first), count_(count), begin_(begin) {
  for (int j = first_; j < first_ + count_; ++j) {
    way_[j] = std::clamp(goal[j], limits[j].lower, limits[j].upper) - start_[j];
    const double seconds = kPeakSpeed * std::abs(way_[j]) / limits[j].velocity;
    duration_ = std::max(duration_, static_cast<std::int64_t>(std::ceil(1e9 * seconds)));
  }
}

void JointMove::apply(std::int64_t stamp, JointArray& joints) const {
  const double passed = static_cast<double>(stamp - begin_);
  const double s = stamp >= end() ? 1 : std::max(0.0, passed / static_cast<double>(duration_));
  for (int j = first_; j < first_ + count_; ++j) joints[j] = start_[j] + leastJerk(s) * way_[j];
}

}  // namespace vibe::sim
