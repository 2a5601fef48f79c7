#pragma once
#include <memory>
#include <optional>
#include <string>

#include "vibe_hardware/driver/calibration.hpp"
#include "vibe_hardware/emulator/emulated_haptic.hpp"
#include "vibe_hardware/emulator/emulated_input.hpp"
#include "vibe_hardware/emulator/hand.hpp"
#include "vibe_hardware/emulator/overstitch_fingers.hpp"

namespace vibe::hardware {

/// Hand and arm at the axes of the haptic device. Form: see HandImpedance; the values are a design choice: a natural
/// frequency of 8 Hz (insertion) and 17 Hz (rotation), damping ratios of one half.
constexpr double kHandMass = 0.2, kHandDamping = 10, kHandStiffness = 500;  // insertion [kg], [N s/m], [N/m]
constexpr HandImpedance kHandOnKnob{3e-5, 5e-3, 0.5};                       // other axes

/// How the emulated devices are built and wired.
struct EmulatorSetup {
  /// Which joint is on which axis, and which button on which bit: that of the host, so that the joints of the scope
  /// move as the hand intends.
  Calibration calibration;
  vibe_firmware::HapticConfig haptic{};
  vibe_firmware::InputConfig input{};
  Drive drive = Drive::Voltage;
  std::string serial = "EMULATOR";  ///< of both devices
};

/// Mechanics that belong to the setup, with the hand.
EmulatedHaptic::Plants plantsOf(const EmulatorSetup& setup);

/// Both devices and the hand that moves them, in virtual time.
class Emulator {
 public:
  Emulator(const EmulatorSetup& setup, std::shared_ptr<const Hand> hand);

  /// One millisecond.
  void tick();
  void tick(int count) {
    for (int i = 0; i < count; ++i) tick();
  }

  double time() const { return kTick * static_cast<double>(ticks_); }  ///< [s]
  /// Time of the hand [s]. It begins when the hand has reached its first position from that of the devices, 0; negative
  /// before.
  double handTime() const { return time() - approach_; }
  bool finished() const { return handTime() > hand_->duration(); }

  EmulatedHaptic& haptic() { return haptic_; }
  EmulatedInput& input() { return input_; }
  EmulatedDevice& device(DeviceKind kind);
  const EmulatorSetup& setup() const { return setup_; }

 private:
  HandSample intention() const;
  DeviceMotion motionOf(DeviceKind device, const HandSample& sample) const;

  EmulatorSetup setup_;
  std::shared_ptr<const Hand> hand_;
  EmulatedHaptic haptic_;
  EmulatedInput input_;
  std::optional<OverstitchFingers> fingers_;
  std::int64_t ticks_ = 0;
  double approach_ = 0;
};

}  // namespace vibe::hardware
