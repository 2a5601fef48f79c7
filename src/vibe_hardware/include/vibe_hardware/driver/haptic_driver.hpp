#pragma once

#include <array>
#include <mutex>
#include <optional>

#include "vibe_firmware/protocol/reports.hpp"
#include "vibe_hardware/driver/device_driver.hpp"
#include "vibe_hardware/driver/joint_scale.hpp"

namespace vibe::hardware {

/// Decides which parameters are sent to the haptic device, and when: a new target at once but at most every 10 ms, and
/// otherwise the present one often enough for the watchdog of the device. If no target has come for 0.1 s, the spring
/// is faded out within 50 ms. Times: host clock [s].
class HapticLink {
 public:
  static constexpr double kMinPeriod = 0.010;  ///< 100 Hz
  static constexpr double kHeartbeat = 0.040;  ///< 50 ms less the time for which the caller may wait
  static constexpr double kTimeout = 0.1;      ///< of a target
  static constexpr double kFade = 0.05;        ///< from the end of a target until its spring is gone [s]

  /// Parameters by axis of the device, each within what is passive there.
  using Springs = std::array<vibe_firmware::AxisParameters, vibe_firmware::kAxisCount>;

  void setTarget(const Springs& springs, double now);  ///< from now on, until the next one, release() or kTimeout
  /// The contact has ended: fades out what is left.
  void release(double now);
  /// A device has been opened, perhaps another one with other limits: forgets the target, and sends parameters without
  /// a spring at once.
  void restart();

  /// Parameters that are due now, if any. Counts as sent.
  std::optional<vibe_firmware::ParameterReport> next(double now);

  const vibe_firmware::ParameterReport& last() const { return report_; }  ///< sent last; number 0: none yet
  bool touching() const { return touching_; }  ///< there is a target; false: none, or its spring fades out

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

/// What became of the parameters.
struct HapticStatistics {
  std::uint64_t sent = 0;        ///< sets of parameters, heartbeats included
  std::uint64_t clamped = 0;     ///< targets that were lowered to what is passive on the device
  std::uint64_t refused = 0;     ///< sets that the device refused
  std::uint64_t mismatched = 0;  ///< sets that read back differently
  std::uint64_t starved = 0;     ///< reports in which the device missed parameters: a heartbeat was lost
  std::string last_refusal;      ///< one sentence; empty: none
  bool in_force = false;         ///< the device holds the set sent last, or the one before
};

/// Driver of the haptic device: a DeviceDriver, and the parameters. setTarget() and release() may be called from any
/// thread, everything else from one.
class HapticDriver {
 public:
  using Targets = std::array<JointSpring, vibe_firmware::kAxisCount>;  ///< by axis of the device [rad], [N m]

  /// @param clock      host time [s], never goes back; read by every thread that calls setTarget() or release()
  /// @param callbacks  called from poll(); all have to be set
  HapticDriver(HidBus& bus, DeviceSelection selection, std::function<double()> clock,
               DeviceDriver::Callbacks callbacks);

  /// Reads reports and sends parameters that are due. @param wait  for the first report [s]
  void poll(double wait);

  /// Spring-dampers to render from now on, in units of the axes; finite, stiffness and damping at least 0.
  void setTarget(const Targets& targets);
  /// @param pause  for which targets are ignored, because they may have been computed before [s]
  void release(double pause = 0);

  DeviceDriver& device() { return device_; }                   ///< for state, connection and statistics of the reports
  HapticStatistics statistics() const { return statistics_; }  ///< since the driver was made

 private:
  static constexpr double kVerifyPeriod = 1;    // [s]
  static constexpr double kVerifyAgain = 0.03;  // after a first difference [s]
  static constexpr double kTakeOver = 0.1;      // from sending a set to its number in the reports [s]

  std::mutex inbox_mutex_;
  std::optional<Targets> inbox_;
  bool inbox_release_ = false;
  double ignored_until_ = 0;  // targets [s]
  DeviceDriver::Callbacks user_;
  HapticLink link_;
  HapticStatistics statistics_;
  std::uint32_t refused_before_ = 0;  // in StatusReport
  double confirmed_ = 0;              // when a report has last shown a recent set [s]
  double opened_ = 0;                 // [s]
  double next_verify_ = 0;
  bool differed_ = false;
  bool refused_flag_ = false;  // of the last report
  bool ask_status_ = false;
  DeviceDriver device_;

  DeviceDriver::Callbacks wrap();
  void onSample(const DeviceSample& sample);
  void takeInbox();
  void sendDue();
  void verify();
  void checkRefusals();
};

/// First difference between two sets: "stiffness of axis 0 is 0.1 instead of 0.2"; empty: none.
std::string firstDifference(const vibe_firmware::ParameterReport& sent, const vibe_firmware::ParameterReport& read);

}  // namespace vibe::hardware
