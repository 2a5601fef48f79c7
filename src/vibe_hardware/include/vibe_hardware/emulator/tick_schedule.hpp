#pragma once
#include <cstdint>

#include "vibe_hardware/emulator/emulated_device.hpp"

namespace vibe::hardware {

/// Decides how many ticks of a millisecond are due by the wall clock. A short delay is made up for; after a long one,
/// for example because the computer was suspended, the time in between is dropped.
class TickSchedule {
 public:
  static constexpr double kBehind = 0.02;  ///< delay that is worth a message [s]
  static constexpr double kDrop = 1;       ///< delay that is not made up for [s]
  static constexpr int kMaxBurst = 50;     ///< ticks at once, so that hosts are served in between

  /// @param start        wall time of the first tick [s]
  /// @param clock_error  by which share the device's clock goes slow [1]: a crystal is wrong by up to 1e-4
  explicit TickSchedule(double start, double clock_error = 0) : origin_(start), tick_(kTick * (1 + clock_error)) {}

  /// Ticks to take now; they count as taken. @param now  wall time [s], never goes back
  int due(double now);

  /// Wall time of the next tick [s].
  double next() const;

  bool behind() const { return delay_ > kBehind; }  ///< at the last due()
  double delay() const { return delay_; }           ///< of the first tick that was due then [s]
  double worstDelay() const { return worst_delay_; }
  double dropped() const { return dropped_; }  ///< time that was left out altogether [s]

 private:
  double origin_;
  double tick_;  // on the host's clock [s]
  std::int64_t ticks_ = 0;
  double delay_ = 0, worst_delay_ = 0, dropped_ = 0;
};

}  // namespace vibe::hardware
