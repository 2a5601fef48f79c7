#include "camera/stamp_clock.hpp"

#include <cmath>

namespace vibe::vision {
namespace {

constexpr double kTaiAhead = 37;    // TAI - UTC since 2017 (IERS bulletin C) [s]
constexpr double kAgrees = 0.5;     // by which a camera that follows PTP may seem late when the host is busy [s]
constexpr double kTooEarly = 1e-3;  // a packet that comes before its exposure ends: the clocks do not agree [s]
constexpr double kJump = 0.05;      // by which a packet cannot be early unless a clock has been set [s]

}  // namespace

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
