#pragma once
#include <memory>
#include <string>

#include "vibe_hardware/driver/joint_scale.hpp"
#include "vibe_hardware/emulator/emulated_haptic.hpp"
#include "vibe_hardware/emulator/emulated_input.hpp"
#include "vibe_hardware/emulator/hand.hpp"

namespace vibe {

/// Hand and arm at the two axes of the haptic device. Form: see HandImpedance; the values are a design choice: a
/// natural frequency of 8 Hz (insertion) and 17 Hz (rotation), damping ratios of one half.
constexpr double kHandMass = 0.2, kHandDamping = 10, kHandStiffness = 500;  // insertion [kg], [N s/m], [N/m]
constexpr HandImpedance kHandOnKnob{3e-5, 5e-3, 0.5};                       // rotation

/// How the emulated devices are built and wired. The defaults belong to config/devices.yaml.
struct EmulatorSetup {
  /// In the order of vibe::Joint; the first two are axes of the haptic device, the others of the input device.
  std::array<JointScale, kScopeJointCount> joints{{{0.01, 0}, {1, 0}, {1, 0}, {1, 0}}};
  vibe_firmware::HapticConfig haptic;
  vibe_firmware::InputConfig input;
  Drive drive = Drive::Voltage;
  std::string serial = "EMULATOR";  ///< of both devices
};

/// Mechanics that belong to the setup, with the hand.
EmulatedHaptic::Plants plantsOf(const EmulatorSetup& setup);

/// Both devices and the hand that moves them, in virtual time. Buttons are bits of the input device, in the order of
/// vibe::Button.
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

 private:
  HandSample intention() const;

  EmulatorSetup setup_;
  std::shared_ptr<const Hand> hand_;
  EmulatedHaptic haptic_;
  EmulatedInput input_;
  std::int64_t ticks_ = 0;
  double approach_ = 0;
};

}  // namespace vibe
