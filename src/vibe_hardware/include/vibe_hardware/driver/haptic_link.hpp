#pragma once
#include <array>
#include <optional>

#include "vibe_firmware/protocol/reports.hpp"

namespace vibe::hardware {

/// Decides which parameters are sent to the haptic device, and when: a new target at once but at most every 10 ms, and
/// otherwise the present one often enough for the watchdog of the device. If no target has come for 0.1 s, the spring
/// is faded out within 50 ms. Times: host clock [s].
class HapticLink {
 public:
  static constexpr double kMinPeriod = 0.010;  ///< 100 Hz
  static constexpr double kHeartbeat = 0.040;  ///< 50 ms less the time for which the caller may wait
  static constexpr double kTimeout = 0.1;      ///< of a target
  static constexpr double kFade = 0.05;

  using Springs = std::array<vibe_firmware::AxisParameters, vibe_firmware::kAxisCount>;

  void setTarget(const Springs& springs, double now);
  /// The contact has ended: fades out what is left.
  void release(double now);
  /// A device has been opened, perhaps another one with other limits: forgets the target, and sends parameters without
  /// a spring at once.
  void restart();

  /// Parameters that are due now, if any. Counts as sent.
  std::optional<vibe_firmware::ParameterReport> next(double now);

  const vibe_firmware::ParameterReport& last() const { return report_; }  ///< sent last; number 0: none yet
  bool touching() const { return touching_; }

 private:
  static constexpr double kNever = -1e9;

  Springs target_{};
  bool touching_ = false;
  bool changed_ = false;
  double target_time_ = kNever;
  double release_time_ = kNever;
  double last_sent_ = kNever;
  vibe_firmware::ParameterReport report_{};

  double gain(double now) const;
};

}  // namespace vibe::hardware
