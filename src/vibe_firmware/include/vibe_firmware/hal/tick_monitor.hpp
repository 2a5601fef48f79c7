#pragma once
#include <cstdint>

namespace vibe_firmware {

/// Tells which ticks of the control loop came late.
class TickMonitor {
 public:
  static constexpr std::uint32_t kLatest = 1100;  ///< after the last tick: 10 % more than the period [us]

  /// @param time_us  of this tick; wraps
  bool isLate(std::uint32_t time_us) {
    const bool late = started_ && time_us - last_us_ > kLatest;
    started_ = true;
    last_us_ = time_us;
    return late;
  }

 private:
  std::uint32_t last_us_ = 0;
  bool started_ = false;
};

}  // namespace vibe_firmware
