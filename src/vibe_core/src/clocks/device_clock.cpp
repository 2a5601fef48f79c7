#include "vibe_core/clocks/device_clock.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace vibe {
namespace {

constexpr double kBucket = 1;  // [s]
// A device whose clock is not that of the bus samples at a phase of the polling that drifts through one period in 20 s
// (100 ppm) to minutes (10 ppm); only where it passes through 0 is the delay small.
constexpr std::size_t kBuckets = 120;
constexpr double kDriftBase = 3;       // no drift is estimated from less [s]
constexpr double kMaxDrift = 1e-3;     // a crystal has 1e-4, an internal oscillator at room temperature 1e-2 at most
constexpr double kLate = 0.05;         // [s]
constexpr double kCatchUp = 0.005;     // by which the delay falls if the host reads a backlog [s]
constexpr double kLateDuration = 0.5;  // of arrivals, after which the device's clock must have stood still [s]

}  // namespace

void DeviceClock::clear() {
  *this = DeviceClock();
}

double DeviceClock::hostTime(double device) const {
  return device + offset_ + slope_ * (device - anchor_);
}

double DeviceClock::deviceTime(double host) const {
  return anchor_ + (host - offset_ - anchor_) / (1 + slope_);
}

void DeviceClock::add(double device, double arrival) {
  const Pair pair{device, arrival - device};
  if (hasStepped(pair, arrival)) minima_.clear();
  keep(pair);
  fit();
}

// If the device was stopped and goes on, its clock is behind for good and by a constant time. Old reports that a busy
// host reads after a stall are late as well, but each is less late than the one before.
bool DeviceClock::hasStepped(const Pair& pair, double arrival) {
  if (minima_.empty() || arrival - hostTime(pair.device) < kLate) {
    late_since_ = -1;
    return false;
  }
  if (late_since_ < 0 || pair.delay < late_delay_ - kCatchUp) {
    late_since_ = arrival;
    late_delay_ = pair.delay;
  }
  if (arrival - late_since_ < kLateDuration) return false;
  late_since_ = -1;
  return true;
}

void DeviceClock::keep(const Pair& pair) {
  const auto bucket = [](const Pair& p) { return std::floor(p.device / kBucket); };
  if (!minima_.empty() && bucket(minima_.back()) == bucket(pair)) {
    if (pair.delay < minima_.back().delay) minima_.back() = pair;
    return;
  }
  minima_.push_back(pair);
  if (minima_.size() > kBuckets) minima_.pop_front();
}

void DeviceClock::fit() {
  const auto smaller = [](const Pair& a, const Pair& b) { return a.delay < b.delay; };
  const Pair lowest = *std::min_element(minima_.begin(), minima_.end(), smaller);
  anchor_ = lowest.device;
  offset_ = lowest.delay;
  slope_ = 0;
  if (minima_.back().device - minima_.front().device < kDriftBase) return;
  // lower convex hull; the edge above the middle has the smallest sum of distances to all pairs
  std::vector<Pair> hull;
  const auto turnsRight = [&hull](const Pair& next) {
    const Pair &a = hull[hull.size() - 2], &b = hull.back();
    return (b.device - a.device) * (next.delay - a.delay) <= (b.delay - a.delay) * (next.device - a.device);
  };
  double middle = 0;
  for (const Pair& pair : minima_) {
    while (hull.size() >= 2 && turnsRight(pair)) hull.pop_back();
    hull.push_back(pair);
    middle += pair.device / static_cast<double>(minima_.size());
  }
  std::size_t k = 1;
  while (k + 1 < hull.size() && hull[k].device < middle) ++k;
  const double slope = (hull[k].delay - hull[k - 1].delay) / (hull[k].device - hull[k - 1].device);
  if (std::abs(slope) > kMaxDrift) return;
  anchor_ = hull[k].device;
  offset_ = hull[k].delay;
  slope_ = slope;
}

}  // namespace vibe
