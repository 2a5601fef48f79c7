#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "vibe_hardware/driver/calibration.hpp"
#include "vibe_hardware/emulator/emulated_device.hpp"
#include "vibe_hardware/emulator/hand.hpp"

namespace vibe::hardware {

/// Decides how many ticks of a millisecond are due by the wall clock. A short delay is made up for; after a long one,
/// for example because the computer was suspended, the time in between is dropped.
class TickSchedule {
 public:
  static constexpr double kBehind = 0.02;  ///< delay that is worth a message [s]
  static constexpr double kDrop = 1;       ///< delay that is not made up for [s]
  static constexpr int kMaxBurst = 50;     ///< ticks at once, so that hosts are served in between

  /// @param start        wall time of the first tick [s]
  /// @param clock_error  by which share the device's clock goes slow: a crystal is wrong by up to 1e-4
  explicit TickSchedule(double start, double clock_error = 0) : origin_(start), tick_(kTick * (1 + clock_error)) {}

  /// Ticks to take now; they count as taken. @param now  wall time [s], never goes back
  int due(double now);

  /// Wall time of the next tick [s].
  double next() const;

  bool behind() const { return delay_ > kBehind; }    ///< at the last due()
  double delay() const { return delay_; }             ///< of the first tick that was due then [s]
  double worstDelay() const { return worst_delay_; }  ///< the largest delay() so far [s]
  double dropped() const { return dropped_; }         ///< time that was left out altogether [s]

 private:
  double origin_;
  double tick_;  // on the host's clock [s]
  std::int64_t ticks_ = 0;
  double delay_ = 0, worst_delay_ = 0, dropped_ = 0;
};

/// The fingers of an emulated hand on the buttons that move the suturing device (Calibration::suturing_device). They
/// press so that the joints follow intended positions, in steps of what the host adds up per report, and no faster than
/// it does.
class SuturingDeviceFingers {
 public:
  /// Positions of helix_advance, helix_rotation and needle_driver [m], [rad], [m]
  using Positions = std::array<double, kSuturingDeviceJointCount>;

  /// Begins with nothing pressed and the joints at 0.
  explicit SuturingDeviceFingers(const std::array<ButtonDrive, kSuturingDeviceJointCount>& drives) : drives_(drives) {}

  /// To be called once per report. @param intended  [m], [rad], [m]
  void decide(const Positions& intended, double report_period);

  /// As decided last; false for a button that moves none of the joints.
  bool isPressed(const DeviceButton& button) const;
  const Positions& positions() const { return positions_; }  ///< that the host should have after the next report

 private:
  std::array<ButtonDrive, kSuturingDeviceJointCount> drives_;
  Positions positions_{};
  std::array<int, kSuturingDeviceJointCount> direction_{};  // 1: forward, -1: backward
};

/// Hand and arm at the axes of the haptic device: mass [kg], damping [N s/m] and stiffness [N/m] at the insertion.
/// Form: see HandImpedance; the values are a design choice: a natural frequency of 8 Hz (insertion) and 17 Hz
/// (rotation), damping ratios of one half.
constexpr double kHandMass = 0.2, kHandDamping = 10, kHandStiffness = 500;
constexpr HandImpedance kHandOnKnob{3e-5, 5e-3, 0.5};  ///< of the other axes

/// How the emulated devices are built and wired.
struct EmulatorSetup {
  /// Which joint is on which axis, and which button on which bit: that of the host, so that the joints of the scope
  /// move as the hand intends.
  Calibration calibration;
  vibe_firmware::HapticConfig haptic{};  ///< firmware of the haptic device: axes, encoders, rates
  vibe_firmware::InputConfig input{};    ///< the same of the input device
  Drive drive = Drive::Voltage;          ///< how the bridges of the motors work: what back-EMF does
  std::string serial = "EMULATOR";       ///< of both devices
};

/// Mechanics that belong to the setup, with the hand.
EmulatedHaptic::Plants plantsOf(const EmulatorSetup& setup);

/// Both devices and the hand that moves them, in virtual time.
class Emulator {
 public:
  /// Both devices at 0. @param hand  not null
  Emulator(const EmulatorSetup& setup, std::shared_ptr<const Hand> hand);

  /// One millisecond.
  void tick();
  /// @param count  milliseconds
  void tick(int count) {
    for (int i = 0; i < count; ++i) tick();
  }

  double time() const { return kTick * static_cast<double>(ticks_); }  ///< [s]
  /// Time of the hand [s]. It begins when the hand has reached its first position from that of the devices, 0; negative
  /// before.
  double handTime() const { return time() - approach_; }
  /// The hand does not move any more; never for one without end.
  bool finished() const { return handTime() > hand_->duration(); }

  EmulatedHaptic& haptic() { return haptic_; }           ///< lives as long as the emulator
  EmulatedInput& input() { return input_; }              ///< lives as long as the emulator
  EmulatedDevice& device(DeviceKind kind);               ///< one of the two
  const EmulatorSetup& setup() const { return setup_; }  ///< as it was given

 private:
  HandSample intention() const;
  DeviceMotion motionOf(DeviceKind device, const HandSample& sample) const;

  EmulatorSetup setup_;
  std::shared_ptr<const Hand> hand_;
  EmulatedHaptic haptic_;
  EmulatedInput input_;
  std::optional<SuturingDeviceFingers> fingers_;
  std::int64_t ticks_ = 0;
  double approach_ = 0;
};

}  // namespace vibe::hardware
