#pragma once
#include <array>
#include <mutex>
#include <optional>

#include "vibe_hardware/driver/device_driver.hpp"
#include "vibe_hardware/driver/haptic_link.hpp"
#include "vibe_hardware/driver/joint_scale.hpp"

namespace vibe::hardware {

/// What became of the parameters.
struct HapticStatistics {
  std::uint64_t sent = 0;
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
  using Targets = std::array<JointSpring, vibe_firmware::kAxisCount>;

  HapticDriver(HidBus& bus, DeviceSelection selection, std::function<double()> clock,
               DeviceDriver::Callbacks callbacks);

  /// Reads reports and sends parameters that are due. @param wait  for the first report [s]
  void poll(double wait);

  /// Spring-dampers to render from now on, in units of the axes; finite, stiffness and damping at least 0.
  void setTarget(const Targets& targets);
  /// @param pause  for which targets are ignored, because they may have been computed before [s]
  void release(double pause = 0);

  DeviceDriver& device() { return device_; }
  HapticStatistics statistics() const { return statistics_; }

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
