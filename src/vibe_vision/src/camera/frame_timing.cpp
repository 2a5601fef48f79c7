#include "camera/frame_timing.hpp"

#include <algorithm>
#include <cmath>

namespace vibe::vision {

namespace {

constexpr std::uint64_t kShortIds = 65535;  // 0 is no frame number

constexpr double kTaiAhead = 37;    // TAI - UTC since 2017 (IERS bulletin C) [s]
constexpr double kAgrees = 0.5;     // by which a camera that follows PTP may seem late when the host is busy [s]
constexpr double kTooEarly = 1e-3;  // a packet that comes before its exposure ends: the clocks do not agree [s]
constexpr double kJump = 0.05;      // by which a packet cannot be early unless a clock has been set [s]

constexpr int kWindow = 30;
constexpr double kMost = 1e6;  // frames of one gap; more is no gap but a clock that was set

}  // namespace

SequenceCounter::Step SequenceCounter::advance(std::uint64_t id) {
  Step step;
  if (!has_begun_) {
    sequence_ = id;
  } else {
    const std::uint64_t steps = is_known_ ? distance(id) : 1;
    sequence_ += steps;
    step.skipped = steps - 1;
  }
  has_begun_ = is_known_ = true;
  last_id_ = id;
  step.sequence = sequence_;
  return step;
}

std::uint64_t SequenceCounter::distance(std::uint64_t id) const {
  if (id > last_id_) return id - last_id_;
  const bool has_wrapped = last_id_ <= kShortIds && last_id_ - id > kShortIds / 2;
  return has_wrapped ? id + kShortIds - last_id_ : 1;  // 1: the camera has begun to count anew
}

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

StampClock::StampClock(CameraClock kind, bool follows_ptp) : kind_(kind), follows_ptp_(follows_ptp) {}

double StampClock::map(double device_end, double first_packet) {
  if (clock_.empty() || hasJumped(device_end, first_packet)) {
    clock_.clear();
    decide(first_packet - device_end);
  }
  last_device_ = device_end;
  clock_.add(device_end, first_packet);
  const double unix_end = device_end - ahead_;
  if (is_host_time_ && kind_ == CameraClock::Auto && first_packet < unix_end - kTooEarly) is_host_time_ = false;
  return is_host_time_ ? unix_end : clock_.hostTime(device_end);
}

void StampClock::decide(double delay) {
  is_host_time_ = false;
  ahead_ = 0;
  if (kind_ == CameraClock::Free || (kind_ == CameraClock::Auto && !follows_ptp_)) return;
  const bool is_tai = std::abs(delay + kTaiAhead) < kAgrees;
  is_host_time_ = is_tai || std::abs(delay) < kAgrees || kind_ == CameraClock::Host;
  if (is_tai) ahead_ = kTaiAhead;
}

bool StampClock::hasJumped(double device_end, double first_packet) const {
  return device_end < last_device_ || first_packet < clock_.hostTime(device_end) - kJump;
}

}  // namespace vibe::vision
